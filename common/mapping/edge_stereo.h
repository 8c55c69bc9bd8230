#pragma once

#include <optional>
#include <vector>

#include "common/mapping/depth_fit.h"
#include "common/mapping/depth_votes.h"
#include "common/mapping/edge_stereo_options.h"
#include "common/mapping/posed_edges.h"

namespace evit {

/// A depth measured for an edge of a view.
struct EdgeDepth {
  int edge = 0;                   // index into the view's edges
  double inverse_depth = 0;       // 1/m, along the optical axis
  double sigma = 0;               // of it, 1/m
  double slope = 0;               // of the inverse depth along the edge's tangent, 1/m per pixel
  double views = 0;               // that agree
  double lag = 0, lag_sigma = 0;  // px, by which event views see it behind its place; sigma 0: not known
};

/// Depth of the edges of one view from its neighbours, semi-dense multi-view stereo on edges.
///
/// For each edge pixel all inverse depths are tried at once in all neighbours: each neighbour votes for those
/// at which it has an edge of this direction on the epipolar line (DepthVotes). The highest peaks are
/// then made exact by least squares on the distances to the neighbours' edges, across these (FitDepth). An
/// edge counts only where one of its sides is about as bright as in the first view. What stays ambiguous, has
/// too few witnesses or runs along the epipolar lines is left out.
class EdgeStereo {
 public:
  EdgeStereo(const std::vector<PosedEdges>& views, const EdgeStereoOptions& options)
      : views_(views), options_(options) {}

  /// `stride`: every how many-th edge of the view is measured. `typical_depth`: m, of the scene; which edges
  /// an event camera's views show is told by it. Ascending by edge.
  std::vector<EdgeDepth> Measure(int key, const std::vector<int>& neighbours, int stride,
                                 double typical_depth) const;

 private:
  // Nothing where it is ambiguous or not well known.
  std::optional<DepthFit> BestFit(const EdgePixel& edge, const std::vector<StereoNeighbour>& neighbours,
                                  const DepthSteps& steps, DepthVotes* votes) const;

  const std::vector<PosedEdges>& views_;
  EdgeStereoOptions options_;
};

}  // namespace evit
