#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/mapping/edge_stereo.h"

namespace evit {

struct SensorDepthOptions {
  double min_depth_m = 0.2, max_depth_m = 8;
  double relative_sigma = 0.01;  // of a depth beside an edge
  double jump = 0.05;            // relative difference of the two sides that makes it the edge of something
};

/// Depths of a view's edges from its depth image (CV_32FC1, m, 0: none). A sensor's depth is worst at edges:
/// it is read some pixels beside, on both sides. Where they differ the edge belongs to what is in front: the
/// nearer side counts. Edges without any depth beside them are left out.
std::vector<EdgeDepth> DepthsFromImage(const PosedEdges& view, const cv::Mat& depth,
                                       const SensorDepthOptions& options);

}  // namespace evit
