#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace evit {

/// The brightness change that events tell of, as a smooth field over the image: signed counts (EventCounter)
/// times the contrast threshold, with coarser copies of itself.
///
/// Four sensor pixels make one of level 0, which evens out the threshold's steps; each further level joins
/// four again. Value and gradient come from one interpolant, the quadratic B-spline.
class EventImage {
 public:
  /// `counts`: CV_8UC1, 128 for none. `blur_sigma`: pixels of each level.
  EventImage(const cv::Mat& counts, double contrast_threshold, double blur_sigma, int levels);

  struct Sample {
    float value;   // of log intensity
    float gx, gy;  // per sensor pixel
  };
  /// At a sensor pixel. Outside the image nothing has happened. Plainly written: the tracker's loops
  /// (photometric_lanes.h) read the same in vector code, and are tested against this.
  Sample At(int level, double x, double y) const;

  int levels() const { return static_cast<int>(pyramid_.size()); }
  const cv::Mat& image(int level) const { return pyramid_[static_cast<std::size_t>(level)]; }

 private:
  std::vector<cv::Mat> pyramid_;  // CV_32FC1
};

}  // namespace evit
