#pragma once

namespace evit {

/// Of EdgeStereo: the depths that are tried, what is known of edges, and what makes a measurement.
struct EdgeStereoOptions {
  double min_depth_m = 0.2, max_depth_m = 10;
  int min_views = 4;             // that agree on a depth
  double min_share = 0.35;       // of the views that should show it: more is hidden than one knows
  double max_rival_share = 0.6;  // another depth with as much of the best one's support makes it ambiguous
  double edge_sigma_px = 0.35;   // of an edge's place in one image, poses' errors included
  double normal_sigma = 0.03;    // rad, of an edge's direction in one image
  double max_relative_sigma = 0.06;  // of the depth; more is not a measurement
  double lag_sigma_px = 0.4;         // of an edge in event views, beside what is known of all
  double side_tolerance = 0.5;       // log intensity: by which one side at least must look the same
};

}  // namespace evit
