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
      support_(options.support_filter),
      distances_(std::size_t(width) * height),
      pass_(width, height, options.blur_sigma_px) {}

SurfaceRenderer::Image SurfaceRenderer::Render(const ActiveEventSurface& surface, const View& view) {
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

  FillDistances(surface, view);
  Image image(distances_.size());
  pass_.Run(distances_.data(), decay, image.data());
  return image;
}

void SurfaceRenderer::FillDistances(const ActiveEventSurface& surface, const View& view) {
  QuantizeDistances(surface.stamps(), distances_.size(), surface.Relative(view.t), shift_, distances_.data());
  std::uint16_t* const out = distances_.data();
  for (std::size_t i = view.begin; view.after != nullptr && i < view.end; ++i) {
    const EventArray& e = *view.after;
    if (e.x[i] >= width_ || e.y[i] >= height_) continue;
    std::uint16_t* const d = out + e.y[i] * std::ptrdiff_t{width_} + e.x[i];
    *d = static_cast<std::uint16_t>(std::min<Utime>(*d, (e.t[i] - view.t) >> shift_));
  }
  if (view.ignored != nullptr) {
    for (const std::int32_t pixel : *view.ignored) out[pixel] = kFar;
  }
}

}  // namespace evit
