#pragma once

namespace evit {

/// Settings of EVPT, photometric tracking by event counts.
struct PhotometricOptions {
  double contrast_threshold =
      0.33;                        // of log intensity: what one event stands for (sets the first speed only)
  double view_margin = 0.08;       // share by which a rendered view is wider than the image
  double blur_sigma_px = 1;        // of event image and view, in their (half resolution) pixels
  int levels = 2;                  // coarse to fine; each level has half the pixels of the one below
  int max_points = 6000;           // of the view, for one level
  double min_gradient = 0.06;      // of log intensity per view pixel; weaker edges cause few events or none
  double robust_scale = 1.5;       // of the Cauchy kernel, in units of the normalised images
  int max_iterations = 10;         // of each level
  double sigma_position_m = 0.05;  // how far the pose may be from the prediction, one standard deviation
  double sigma_rotation_rad = 0.05;
  double sigma_velocity = 0.5;   // m/s: how far the velocity may be from the last one
  double sigma_rate = 1;         // rad/s
  double min_correlation = 0.4;  // 0..1: of event image and predicted image; below it a frame is bad
  double max_bad_s = 0.3;        // s of bad frames at constant velocity, before the tracker says LOST
};

/// All that PhotometricTracker needs to know.
struct PhotometricTrackerOptions {
  PhotometricOptions photometric;
  int min_events = 2000;  // a frame of fewer says too little about the pose
  double lag_px = 0.25;   // how far events are behind the edges that cause them (SurfaceOptions has the same)
  double min_depth_m = 0.1;  // of the map in view; these four as in PointOptions and WindowOptions
  double max_depth_m = 12;
  double map_sigma_m = 0.0012;
  double stamp_sigma_us = 400;
};

}  // namespace evit
