#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/tracking/surface_lanes.h"

namespace evit {

/// A negated time surface as a smooth cost field over the image (paper Sec. III-B.2), with coarser copies of
/// itself for starts far from the minimum. Values 0 (event just now) .. 255 (none).
///
/// Value and gradient come from one interpolant, the quadratic B-spline over the pixels: continuously
/// differentiable, without overshoot, nine taps. It smooths by another quarter pixel squared, which the
/// surface's own blur dwarfs.
class SurfaceField {
 public:
  /// `surface`: CV_8UC1, shared: it must not change. One that only points at somebody's memory is copied.
  /// `levels` >= 1: level l is 2^l times smaller.
  SurfaceField(const cv::Mat& surface, int levels);

  int levels() const { return static_cast<int>(pyramid_.size()); }
  const cv::Mat& image(int level) const { return pyramid_[level]; }

  struct Sample {
    float value;          // 0..255
    float gx, gy;         // per pixel of level 0
    float hxx, hxy, hyy;  // per squared pixel of level 0
  };
  /// At pixel (x, y) of level 0. Outside the image the nearest border value counts, with no gradient across.
  Sample At(int level, double x, double y) const;
  /// For samples of many places at once.
  LaneField Lanes(int level) const;

 private:
  std::vector<cv::Mat> pyramid_;
};

}  // namespace evit
