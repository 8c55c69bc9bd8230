#pragma once

#include <cstddef>
#include <vector>

#include "common/simd/lanes.h"

namespace evit {

/// Points of a photometric map as one view sees them, as arrays for loops over lanes: these can read a whole
/// block from any splat on.
class Splats {
 public:
  std::size_t size() const { return n_; }
  const float* x() const { return x_.data(); }  // pixels
  const float* y() const { return y_.data(); }
  const float* depth() const { return depth_.data(); }  // m, positive
  const float* intensity() const { return intensity_.data(); }

  void Clear() { n_ = 0; }
  /// Makes room for so many more.
  void Reserve(std::size_t more) {
    if (x_.size() >= n_ + more + kLanes) return;
    const std::size_t size = 2 * (n_ + more) + kLanes;
    for (std::vector<float>* v : {&x_, &y_, &depth_, &intensity_}) v->resize(size);
  }
  /// Of a block, those whose `keep` is 1; there must be room for the whole block.
  EVIT_ALWAYS_INLINE void Append(const float* x, const float* y, const float* depth, const float* intensity,
                                 const int* keep, int n) {
    for (int l = 0; l < n; ++l) {  // no branch: whether a point is in view is hard to predict
      x_[n_] = x[l], y_[n_] = y[l], depth_[n_] = depth[l], intensity_[n_] = intensity[l];
      n_ += static_cast<std::size_t>(keep[l]);
    }
  }
  /// After the last one: what lies beyond are numbers, too.
  void Pad() {
    Reserve(0);
    for (std::size_t k = n_; k < n_ + kLanes; ++k) x_[k] = y_[k] = intensity_[k] = 0, depth_[k] = 1;
  }

 private:
  std::size_t n_ = 0;
  std::vector<float> x_, y_, depth_, intensity_;
};

}  // namespace evit
