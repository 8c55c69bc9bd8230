#include "common/events/reference_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evit {

ReferenceSurface::ReferenceSurface(int width, int height, const SurfaceOptions& options)
    : width_(width),
      height_(height),
      options_(options),
      last_(static_cast<std::size_t>(width) * height, -std::numeric_limits<double>::infinity()) {}

void ReferenceSurface::Update(const EventArray& events, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    last_[At(events.x[i], events.y[i])] = static_cast<double>(events.t[i]);
  }
}

std::vector<double> ReferenceSurface::Render(Utime t, double decay_us, const EventArray& after,
                                             std::size_t begin, std::size_t end) const {
  std::vector<double> distance(last_.size());  // us, in time, to the nearest event
  for (std::size_t k = 0; k < last_.size(); ++k) distance[k] = static_cast<double>(t) - last_[k];
  for (std::size_t i = begin; i < end; ++i) {
    double& nearest = distance[At(after.x[i], after.y[i])];
    nearest = std::min(nearest, static_cast<double>(after.t[i] - t));
  }
  std::vector<double> image(last_.size());
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const double value = 255 * std::exp(-distance[At(x, y)] / decay_us);  // Eq. (2), times 255
      const bool seen = value >= options_.truncation &&
                        (!options_.support_filter || Supported(distance, 2 * decay_us, x, y));
      image[At(x, y)] = seen ? value : 0;
    }
  }
  image = Blurred(Blurred(image, true), false);
  for (double& value : image) value = 255 - value;  // the negated surface, a cost field
  return image;
}

// Whether one of the eight neighbours has an event within `reach` us.
bool ReferenceSurface::Supported(const std::vector<double>& distance, double reach, int x, int y) const {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
      if ((u != x || v != y) && distance[At(u, v)] <= reach) return true;
    }
  }
  return false;
}

// Gaussian of radius 3 sigma along one axis, reflected at the border.
std::vector<double> ReferenceSurface::Blurred(const std::vector<double>& image, bool along_x) const {
  const double sigma = options_.blur_sigma_px;
  const int radius = sigma > 0 ? static_cast<int>(std::lround(6 * sigma)) / 2 : 0;
  const auto reflect = [](int i, int n) { return i < 0 ? -i : i >= n ? 2 * n - 2 - i : i; };
  std::vector<double> out(image.size());
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      double sum = 0, weights = 0;
      for (int k = -radius; k <= radius; ++k) {
        const double weight = k == 0 ? 1 : std::exp(-0.5 * k * k / (sigma * sigma));
        sum +=
            weight * (along_x ? image[At(reflect(x + k, width_), y)] : image[At(x, reflect(y + k, height_))]);
        weights += weight;
      }
      out[At(x, y)] = sum / weights;
    }
  }
  return out;
}

}  // namespace evit
