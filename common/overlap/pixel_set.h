#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace evit {

/// Some pixels of an image: those that fired, or those that a map projects to.
class PixelSet {
 public:
  PixelSet() = default;
  PixelSet(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  std::int64_t size() const { return size_; }
  /// Outside the image: does nothing.
  void Add(int x, int y);
  /// Outside the image: false.
  bool Has(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_ && bits_[Index(x, y)]; }

 private:
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  std::int64_t size_ = 0;
  std::vector<bool> bits_;
};

/// Looks for the nearest pixel of a set, up to some distance.
class NearestPixel {
 public:
  /// `reach` > 0: pixels.
  explicit NearestPixel(double reach);

  /// From `at` (pixels; the middle of the top left one is (0, 0)) to the middle of the nearest pixel of
  /// `set`. False where none is within reach.
  bool Find(const PixelSet& set, const Eigen::Vector2d& at, Eigen::Vector2d* offset) const;

 private:
  double reach_;
  std::vector<Eigen::Vector2i> steps_;  // whole pixels, nearest first
};

}  // namespace evit
