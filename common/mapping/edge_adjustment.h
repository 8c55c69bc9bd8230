#pragma once

#include <vector>

#include "common/mapping/edge_adjustment_options.h"
#include "common/mapping/point_evidence.h"
#include "common/mapping/posed_edges.h"

namespace evit {

/// What became of the poses.
struct AdjustmentSummary {
  double rms_before_px = 0, rms_after_px = 0;  // of points' distances to the edges, across
  double moved_m = 0, turned_deg = 0;          // medians over the views
};

/// Fits points and poses to the edges of all views, by turns: each point to the edges it is seen as (a line
/// has a place across itself only), its direction to how these slant (PointEvidence), each view, within what
/// is known of its pose, to the points that it sees (FitViewPose). So an error of a single view's pose no
/// longer doubles its lines. Afterwards a point knows its sigma, how many views show it, and which share of
/// those that should; points that too few show are dropped.
class EdgeAdjustment {
 public:
  EdgeAdjustment(std::vector<PosedEdges>* views, const EdgeAdjustmentOptions& options, int threads)
      : views_(views), options_(options), threads_(threads) {}

  AdjustmentSummary Run(std::vector<MappedPoint>* points);

 private:
  // How points are looked for in the views.
  struct Search {
    double radius;  // px
    int every;      // each point in every how many-th view
    bool last;      // the round that only judges
  };
  struct Sightings;  // of all points

  Search SearchOf(int round) const;
  Sightings Collect(const std::vector<MappedPoint>& points, const Search& search) const;
  void CollectIn(int view, const std::vector<MappedPoint>& points, const Search& search,
                 Sightings* sightings) const;
  bool IsShown(const PointEvidence& evidence, const Search& search) const;
  void FitPoints(const Sightings& sightings, const Search& search, std::vector<MappedPoint>* points,
                 std::vector<MappedPoint>* measured) const;

  std::vector<PosedEdges>* views_;
  EdgeAdjustmentOptions options_;
  int threads_;
};

}  // namespace evit
