#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/mapping/posed_edges.h"

namespace evit {

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
  // Moving a point from where it was costs as much as so many of its sigmas: what a line knows of its depth
  // from neighbours along it is not lost. 0: costs nothing.
  double hold_sigmas = 5;
};

/// What became of the poses.
struct AdjustmentSummary {
  double rms_before_px = 0, rms_after_px = 0;  // of points' distances to the edges, across
  double moved_m = 0, turned_deg = 0;          // medians over the views
};

/// Fits points and poses to the edges of all views, by turns: each point to the edges it is seen as (a line
/// has a place across itself only), its direction to how these slant, each view, within what is known of its
/// pose, to the points that it sees. So an error of a single view's pose no longer doubles its lines.
/// Afterwards a point knows its sigma, how many views show it, and which share of those that should; points
/// that too few show are dropped.
class EdgeAdjustment {
 public:
  EdgeAdjustment(std::vector<PosedEdges>* views, const EdgeAdjustmentOptions& options, int threads)
      : views_(views), options_(options), threads_(threads) {}

  AdjustmentSummary Run(std::vector<MappedPoint>* points);

 private:
  struct Sums;
  std::vector<std::int32_t> Visible(const PosedEdges& view, const std::vector<MappedPoint>& points) const;
  // How points are looked for in the views: within what radius, px, and each in every how many-th view.
  struct Search {
    double radius;
    int every;
  };
  void Collect(int view, const std::vector<MappedPoint>& points, const Search& search,
               std::vector<Sums>* sums, double* squares, std::size_t* n) const;
  void MovePose(const std::vector<MappedPoint>& points, double radius, const SE3& given,
                PosedEdges* view) const;

  std::vector<PosedEdges>* views_;
  EdgeAdjustmentOptions options_;
  int threads_;
};

}  // namespace evit
