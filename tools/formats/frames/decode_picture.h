#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "tools/formats/frames/frame_source.h"

namespace evit::formats {

/// What all pictures of one camera have in common, and one alone does not always show.
struct PictureStyle {
  double white = 0;  // the level that becomes 255; 0: by each picture alone
  bool mosaic =
      false;  // the colours of a Bayer pattern stand side by side, in a picture that says it is grey
};

/// A picture as grey, CV_8UC1: colour is weighted, Bayer patterns are filled in, of 10, 12, 14 or 16 bits the
/// upper eight stay. Throws std::runtime_error naming it: damaged, no picture, an encoding that is not known.
cv::Mat DecodeGrey(const StoredPicture& picture, const std::string& name, const PictureStyle& style = {});

/// The same before bits are cut off: CV_8UC1 or CV_16UC1. `is_raw`, where not null: whether one channel is
/// stored.
cv::Mat DecodeLevels(const StoredPicture& picture, const std::string& name, bool* is_raw = nullptr);

/// The highest level of 10, 12, 14 or 16 bits that a picture with such a brightest pixel can have: cameras
/// leave the upper bits empty. 255 for CV_8UC1.
double WhiteOf(const cv::Mat& levels);

/// Depth as CV_32FC1 in metres, 0: none. `units_per_metre`: of whole numbers (16 bit); floats are metres.
/// Throws as DecodeGrey does.
cv::Mat DecodeDepth(const StoredPicture& picture, double units_per_metre, const std::string& name);

}  // namespace evit::formats
