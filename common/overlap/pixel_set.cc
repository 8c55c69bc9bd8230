#include "common/overlap/pixel_set.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr double kRounding = 0.7072;  // pixels: farthest that a place is from the middle of its pixel

}  // namespace

PixelSet::PixelSet(int width, int height)
    : width_(width),
      height_(height),
      bits_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), false) {}

void PixelSet::Add(int x, int y) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_ || bits_[Index(x, y)]) return;
  bits_[Index(x, y)] = true;
  ++size_;
}

NearestPixel::NearestPixel(double reach) : reach_(reach) {
  const int most = static_cast<int>(std::ceil(reach + kRounding));
  for (int y = -most; y <= most; ++y) {
    for (int x = -most; x <= most; ++x) {
      if (std::hypot(x, y) <= reach + kRounding) steps_.emplace_back(x, y);
    }
  }
  std::stable_sort(steps_.begin(), steps_.end(), [](const Eigen::Vector2i& a, const Eigen::Vector2i& b) {
    return a.squaredNorm() < b.squaredNorm();
  });
}

bool NearestPixel::Find(const PixelSet& set, const Eigen::Vector2d& at, Eigen::Vector2d* offset) const {
  const Eigen::Vector2i middle(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
  double best = reach_;
  bool found = false;
  for (const Eigen::Vector2i& step : steps_) {
    if (step.cast<double>().norm() - kRounding > best) break;
    const Eigen::Vector2i pixel = middle + step;
    if (!set.Has(pixel.x(), pixel.y())) continue;
    const Eigen::Vector2d to = pixel.cast<double>() - at;
    if (to.norm() > best) continue;
    best = to.norm();
    *offset = to;
    found = true;
  }
  return found;
}

}  // namespace evit
