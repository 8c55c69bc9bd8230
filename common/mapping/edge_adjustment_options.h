#pragma once

namespace evit {

/// Of EdgeAdjustment: what is known beforehand, and what a point has to show to be kept.
struct EdgeAdjustmentOptions {
  int rounds = 3;
  bool move_poses = true;
  // How well the poses are known that were given.
  double pose_sigma_m = 0.003, pose_sigma_deg = 0.15;
  double edge_sigma_px = 0.35;
  double normal_sigma = 0.03;                          // rad, of an edge's direction in one view
  double direction_sigma = 0.3;                        // rad, of a point's direction as it is given
  double lag_sigma_px = 0.4;                           // of a point's lag in event views
  double first_radius_px = 2.5, last_radius_px = 1.5;  // within which a point's edge is looked for
  double min_share = 0.25;                             // of the views that should show a point
  int min_views = 5;                                   // that show it
  // Where fewer than `min_views` look at a point, it stays if they all show it: a depth that was measured
  // needs no second view, one that was triangulated does.
  bool fewer_if_all = false;
  // Moving a point from where it was costs as much as so many of its sigmas: what a line knows of its depth
  // from neighbours along it is not lost. 0: costs nothing.
  double hold_sigmas = 0.5;
};

}  // namespace evit
