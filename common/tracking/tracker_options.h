#pragma once

#include <cstdint>

#include "common/tracking/robust_kernel.h"

namespace evit {

/// Which map points a keyframe is aligned with.
struct PointOptions {
  int max_active = 9300;    // points asked of map_server for one view
  int per_keyframe = 8000;  // of those, used by the solver for each keyframe; a random subset where fewer
  double margin_px = 64;    // how much wider than the image the frustum of the predicted pose is
  double min_depth_m = 0.1;
  double max_depth_m = 12;
  bool occlusion = true;  // leave out points hidden behind nearer ones
  std::int64_t seed = 1;  // of every random choice
};

/// The sliding window (paper Sec. III-D), and the terms that its covariance adds.
struct WindowOptions {
  enum class FirstNode {
    kFixed,  // the paper's: the oldest keyframe's whole state stays as it is
    kPrior   // what has left the window stays as a Gaussian prior on the oldest keyframe (marginalisation)
  };
  enum class MotionModel { kPreviousPose, kConstantVelocity, kImu };

  int size = 5;  // keyframes N
  RobustKernel::Kind kernel = RobustKernel::Kind::kCauchy;
  FirstNode first_node = FirstNode::kPrior;
  double image_sigma =
      100;  // grey levels: noise of one surface value (docs/explanation/method.md argues the figure)
  double robust_scale = 80;  // grey levels: scale of the kernel
  int max_iterations = 12;
  double imu_noise_factor = 2;  // on the calibrated densities: covers integration error and vibration
  MotionModel motion_model = MotionModel::kImu;  // what predicts the next keyframe's pose
  double correlated_share = 1;  // covariance: fraction of one keyframe's variance that is common to all
  double misfit_share = 2;      // covariance: image and map may be shifted as a whole, by so many times what
                            // patches of the map lie beside their events beyond what the pixel grid explains
  double map_sigma_m = 0;       // covariance: 1-sigma offset of the whole map, per axis
  double stamp_sigma_us = 400;  // covariance: 1-sigma event latency beyond the rig's time_offset_us
};

/// When bootstrapping has seen enough, and what it refuses (paper Sec. III-C).
struct BootstrapOptions {
  int min_frames = 10;               // localised frames before velocities and biases are solved for
  double min_displacement_m = 0.02;  // motion of the body, or
  double min_rotation_deg = 2;       // of the body, or
  double max_duration_s = 0.15;      // after this long without either, if frames have min_events on average
  double max_gyro_bias = 0.1;        // rad/s: a larger solution is refused (map not upright, wrong rig)
  double max_accel_bias = 0.6;       // m/s^2
  double min_contrast = 0;  // 0..1: by how much points must lie better on a frame's events than beside them
};

/// When tracking has failed.
struct FailureOptions {
  double min_contrast = 0;  // 0..1: as in bootstrapping
  double max_coast_s = 2;   // without events that fit: the IMU carries the pose, with growing uncertainty
  double max_position_sigma_m = 0.15;  // LOST above this, while the IMU alone carries the pose
  double max_speed = 6;                // m/s
  double max_gyro_bias = 0.2;          // rad/s
  double max_accel_bias = 1.5;         // m/s^2
  double max_imu_gap_ms = 200;         // a longer gap in the IMU stream restarts bootstrapping
};

/// All that a tracker needs to know.
struct TrackerOptions {
  PointOptions points;
  WindowOptions window;
  BootstrapOptions bootstrap;
  FailureOptions failure;
  int min_events = 500;  // a keyframe of fewer is hardly more than noise (KeyframeOptions has the same)
  double lag_px = 0.25;  // how far events are behind the edges that cause them (SurfaceOptions has the same)
  bool event_only = false;  // EVT: each frame by its events alone, no IMU
};

}  // namespace evit
