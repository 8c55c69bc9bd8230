#pragma once

#include <algorithm>
#include <cstddef>

#include "common/geometry/camera.h"

namespace evit {

/// Squares that an image is cut into where statistics are taken: points on one edge err together, squares
/// hardly do. A 24th of the image's width each, 27 pixels of 640: wider than an edge's events, shorter than
/// most edges.
class ImagePatches {
 public:
  explicit ImagePatches(const Camera& camera)
      : side_(std::max(kSmallest, camera.width / kAcross)),
        columns_(camera.width / side_ + 1),
        rows_(camera.height / side_ + 1) {}

  std::size_t size() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  /// 0 .. size(), of a pixel inside the image.
  std::size_t At(float u, float v) const {
    const int column = static_cast<int>(u) / side_, row = static_cast<int>(v) / side_;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

 private:
  static constexpr int kAcross = 24;
  static constexpr int kSmallest = 6;  // pixels

  int side_, columns_, rows_;  // pixels; patches
};

}  // namespace evit
