#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "tools/formats/frames/frame_source.h"

namespace evit::formats {

/// A picture as grey, CV_8UC1: colour is weighted, Bayer patterns are filled in, of 10, 12 or 16 bits the
/// upper eight stay. Throws std::runtime_error naming it: damaged, no picture, an encoding that is not known.
cv::Mat DecodeGrey(const StoredPicture& picture, const std::string& name);

/// Depth as CV_32FC1 in metres, 0: none. `units_per_metre`: of whole numbers (16 bit); floats are metres.
/// Throws as DecodeGrey does.
cv::Mat DecodeDepth(const StoredPicture& picture, double units_per_metre, const std::string& name);

}  // namespace evit::formats
