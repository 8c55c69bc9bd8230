#pragma once

#include <opencv2/core.hpp>

#include "tools/simulation/random.h"

namespace evit::simulation {

/// Kinds of procedural pictures.
enum class Paint {
  kPlain,     // one grey
  kGradient,  // smooth, without edges
  kShapes,    // discs, rectangles, triangles, lines
  kText,      // lines of blocks like printed words
  kChecker,
  kStripes,
  kPhoto,  // soft noise at several scales with a few hard contours
  kWood,   // fine grain along one direction
  kTiles,  // large fields with joints
};

/// A CV_32F picture, grey 10..250, of width x height texels of `texel_size` metres. `base`: mean grey.
cv::Mat PaintPicture(Paint paint, int width, int height, double texel_size, double base, Random* random);

}  // namespace evit::simulation
