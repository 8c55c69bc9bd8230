#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/mapping/edge_image.h"

namespace evit {

/// The edges of `found` that hang together with a sure one, in lines of at least `min_length` pixels, in
/// their order. `index`: CV_32S, at each pixel the edge found there, -1: none, and none on the border.
/// `sure`: of each edge, not 0 where it would count by itself.
std::vector<EdgePixel> KeepLines(const cv::Mat& index, const std::vector<EdgePixel>& found,
                                 const std::vector<char>& sure, int min_length);

/// Normals from where the edges around lie, 4 pixels to each side along the line, instead of from one pixel's
/// gradient: it is several times as exact. Edges whose line is too short or bends keep theirs. `index`: as
/// above.
void FitNormals(const cv::Mat& index, std::vector<EdgePixel>* found);

}  // namespace evit
