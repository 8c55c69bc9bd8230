#pragma once

#include <vector>

#include "common/mapping/edge_stereo.h"

namespace evit {

struct DepthFusionOptions {
  double reach_px = 6;     // along an edge: neighbours that a depth is compared with
  int min_along = 2;       // of them that must agree: a lone depth is an accident
  int min_other_keys = 4;  // key views that confirm a depth, where so many see the place
  int least_keys = 1;      // that do in any case; 0: a depth in the sight of one key view alone counts
  double max_off_px = 1.5;
  double relative_tolerance = 0.01;  // of the depth, beside three sigma
};

/// The depths of one key view.
struct KeyDepths {
  int view = 0;
  std::vector<EdgeDepth> depths;  // ascending by edge
};

/// Smooths depths along the edges of their own view (a line, fitted to the neighbours that agree; also the
/// edge's slope), and drops those that no neighbour agrees with.
void SmoothAlongEdges(const PosedEdges& view, const DepthFusionOptions& options,
                      std::vector<EdgeDepth>* depths);

/// Points of the map from the depths of all key views: each depth is projected into the other key views,
/// fused (as Gaussians) with the depths there that agree, and dropped where too few do. One point for each
/// depth that stays, in the order of the keys.
std::vector<MappedPoint> FuseDepths(const std::vector<PosedEdges>& views, const std::vector<KeyDepths>& keys,
                                    const DepthFusionOptions& options, int threads);

}  // namespace evit
