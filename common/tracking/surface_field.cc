#include "common/tracking/surface_field.h"

#include <opencv2/imgproc.hpp>

namespace evit {

SurfaceField::SurfaceField(const cv::Mat& surface, int levels) {
  pyramid_.reserve(levels);
  // An image that only points at somebody's memory has no owner, and might not live as long.
  const bool has_owner = surface.u != nullptr;
  pyramid_.push_back(has_owner ? surface : surface.clone());
  for (int l = 1; l < levels; ++l) {
    cv::Mat half;
    cv::pyrDown(pyramid_.back(), half);  // its pixel (i, j) lies on (2i, 2j)
    pyramid_.push_back(half);
  }
}

LaneField SurfaceField::Lanes(int level) const {
  const cv::Mat& image = pyramid_[level];
  // Three columns are read as four bytes: one more must be there on the right.
  return {image.data, static_cast<int>(image.step), 1.0F / static_cast<float>(1 << level),
          static_cast<float>(image.cols - 3), static_cast<float>(image.rows - 2)};
}

SurfaceField::Sample SurfaceField::At(int level, double x, double y) const {
  alignas(64) float u[kLanes] = {static_cast<float>(x)}, v[kLanes] = {static_cast<float>(y)};
  FieldLanes lanes;
  SampleLanes<true>(Lanes(level), u, v, &lanes);
  return {lanes.value[0], lanes.gx[0], lanes.gy[0], lanes.hxx[0], lanes.hxy[0], lanes.hyy[0]};
}

}  // namespace evit
