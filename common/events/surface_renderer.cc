#include "common/events/surface_renderer.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr std::uint16_t kFar = 65535;      // units of time: nothing there
constexpr double kSupportDecays = 2;       // a neighbour supports a pixel if it fired within so many decays
constexpr double kMaxDistance = 60'000.0;  // units: what is visible lies below, after the shift

}  // namespace

double VisibleUs(double decay_us, double truncation) {
  // Below half a grey level T rounds to 0 in any case.
  return decay_us * std::log(255 / std::clamp(truncation, 0.5, 255.0));
}

SurfaceRenderer::SurfaceRenderer(int width, int height, const SurfaceOptions& options)
    : width_(width),
      height_(height),
      truncation_(options.truncation),
      split_(options.split_polarity),
      support_(options.support_filter),
      pass_(width, height, options.blur_sigma_px) {
  for (auto& plane : distances_) plane.resize(std::size_t(width) * height);
}

std::vector<SurfaceRenderer::Image> SurfaceRenderer::Render(const ActiveEventSurface& surface,
                                                            const View& view) {
  const double visible = std::min(VisibleUs(view.decay_us, truncation_), 5e8);
  const double supporting = kSupportDecays * view.decay_us;
  shift_ = 0;
  while (std::max(visible, support_ ? supporting : 0) / (1 << shift_) > kMaxDistance) ++shift_;
  const double unit = 1 << shift_;
  SurfacePass::Decay decay;
  decay.rate = unit / view.decay_us;
  decay.max_distance = static_cast<std::uint16_t>(visible / unit);
  decay.near_distance = static_cast<std::uint16_t>(supporting / unit);
  decay.support = support_;

  std::vector<Image> images;
  const auto draw = [&](const Plane& distances, const Plane& neighbours) {
    images.emplace_back(distances.size());
    pass_.Run(distances.data(), neighbours.data(), decay, images.back().data());
  };
  if (!split_) {
    FillDistances(surface, view, true, true, &distances_[0]);
    draw(distances_[0], distances_[0]);
    return images;
  }
  FillDistances(surface, view, true, false, &distances_[0]);
  FillDistances(surface, view, false, true, &distances_[1]);
  if (support_) {
    nearest_.resize(distances_[0].size());
    std::transform(distances_[0].begin(), distances_[0].end(), distances_[1].begin(), nearest_.begin(),
                   [](std::uint16_t a, std::uint16_t b) { return std::min(a, b); });
  }
  draw(distances_[1], nearest_);
  draw(distances_[0], nearest_);
  return images;
}

void SurfaceRenderer::FillDistances(const ActiveEventSurface& surface, const View& view, bool darker,
                                    bool brighter, Plane* distances) const {
  QuantizeDistances(surface.stamps(darker ? 0 : 1), surface.stamps(brighter ? 1 : 0), distances->size(),
                    surface.Relative(view.t), shift_, distances->data());
  std::uint16_t* const out = distances->data();
  for (std::size_t i = view.begin; view.after != nullptr && i < view.end; ++i) {
    const EventArray& e = *view.after;
    if (!(e.p[i] != 0 ? brighter : darker) || e.x[i] >= width_ || e.y[i] >= height_) continue;
    std::uint16_t* const d = out + e.y[i] * std::ptrdiff_t{width_} + e.x[i];
    *d = static_cast<std::uint16_t>(std::min<Utime>(*d, (e.t[i] - view.t) >> shift_));
  }
  if (view.ignored != nullptr) {
    for (const std::int32_t pixel : *view.ignored) out[pixel] = kFar;
  }
}

}  // namespace evit
