#pragma once

#include <vector>

#include "common/mapping/edge_stereo_options.h"
#include "common/mapping/stereo_neighbour.h"

namespace evit {

/// An edge's inverse depth, by least squares on its distances to the neighbours' edges, across these.
struct DepthFit {
  double inverse_depth = 0, sigma = 0;  // 1/m
  double views = 0;                     // that agree; 0: there is no fit
  double share = 0;                     // of the views that should show it, those that agree
  double support = 0;                   // the weights of those that agree
  double lag = 0, lag_sigma = 0;        // px, see EdgeDepth
};

/// From an inverse depth that is right to within a step or two. The neighbours are aimed at the edge.
DepthFit FitDepth(const EdgePixel& edge, const std::vector<StereoNeighbour>& neighbours, double inverse_depth,
                  double step, const EdgeStereoOptions& options);

}  // namespace evit
