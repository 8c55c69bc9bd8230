#include "tools/formats/frames/picture_style.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace evit::formats {
namespace {

// In pictures as eyes see them pixels two apart differ more than neighbours; in noise, as much.
constexpr double kMosaicRatio = 1.3;

// Mean difference of pixels so far apart in x and y.
double MeanDifference(const cv::Mat& levels, int x, int y) {
  const cv::Rect from(0, 0, levels.cols - x, levels.rows - y), to(x, y, from.width, from.height);
  cv::Mat difference;
  cv::absdiff(levels(from), levels(to), difference);
  return cv::mean(difference)[0];
}

bool IsMosaic(const cv::Mat& levels) {
  if (levels.cols < 8 || levels.rows < 8) return false;
  const double x = MeanDifference(levels, 2, 0), y = MeanDifference(levels, 0, 2);
  return MeanDifference(levels, 1, 0) > kMosaicRatio * x && MeanDifference(levels, 0, 1) > kMosaicRatio * y;
}

}  // namespace

PictureStyle StyleOf(const std::vector<StoredPicture>& samples) {
  PictureStyle style;
  int raw = 0, mosaics = 0;
  for (const StoredPicture& sample : samples) {
    bool is_raw = false;
    cv::Mat levels;
    try {
      levels = DecodeLevels(sample, "", &is_raw);
    } catch (const std::runtime_error&) {
      continue;  // counted where all are read
    }
    style.white = std::max(style.white, WhiteOf(levels));
    if (!is_raw) continue;
    ++raw;
    mosaics += IsMosaic(levels) ? 1 : 0;
  }
  style.mosaic = 2 * mosaics > raw;
  return style;
}

}  // namespace evit::formats
