#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/mapping/edge_image.h"

namespace evit {

struct EdgeDetectorOptions {
  double blur_sigma_px = 0.7;
  double dark_level = 8;       // grey levels of 255 added before logarithms: noise of the dark counts less
  double min_contrast = 0.25;  // step of log intensity: along a line that has
  double sure_contrast = 0.5;  // this much somewhere; an event camera's threshold is about as much
  double side_px = 2.5;        // where the brightness beside an edge is read
  int min_length = 6;          // pixels of a connected line; shorter ones are specks
};

/// Edges of a grey image, to a fraction of a pixel: maxima of the gradient of intensity along its own
/// direction, followed from sure ones to less sure ones. Places come from intensity itself: in its logarithm
/// a blurred edge would lie on the dark side of where it is. Contrast counts in log intensity, as in an event
/// camera. Normals point to the brighter side. `grey`: CV_8UC1; `valid`: CV_8UC1, 0 where the image says
/// nothing, or empty. Row by row.
std::vector<EdgePixel> DetectEdges(const cv::Mat& grey, const cv::Mat& valid,
                                   const EdgeDetectorOptions& options);

}  // namespace evit
