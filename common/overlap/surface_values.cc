#include "common/overlap/surface_values.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr double kBeside = 10, kBorder = kBeside + 2;  // pixels

double Bilinear(const SurfaceRenderer::Image& image, int width, const Eigen::Vector2d& at) {
  const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
  const double a = at.x() - x, b = at.y() - y;
  const std::uint8_t* row = image.data() + static_cast<std::ptrdiff_t>(y) * width + x;
  return (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * row[width] + a * row[width + 1]);
}

void DropFirst(std::size_t n, EventArray* events) {
  const auto erase = [n](auto* v) { v->erase(v->begin(), v->begin() + static_cast<std::ptrdiff_t>(n)); };
  erase(&events->t), erase(&events->x), erase(&events->y), erase(&events->p);
}

}  // namespace

SurfaceMeter::SurfaceMeter(const Rig& rig, const std::vector<MapView>* views, const SurfaceOptions& surface)
    : rig_(rig),
      views_(views),
      policy_({}, surface),
      lookahead_(surface.kind == SurfaceOptions::Kind::kSymmetric ? std::llround(1e3 * surface.lookahead_ms)
                                                                  : 0),
      surface_(rig.camera.width, rig.camera.height),
      renderer_(rig.camera.width, rig.camera.height, surface) {}

void SurfaceMeter::AddEvents(const EventArray& events) {
  for (std::size_t k = 0; k < events.size(); ++k)
    pending_.push_back(events.t[k], events.x[k], events.y[k], events.p[k]);
  while (next_ < views_->size() && !pending_.t.empty() &&
         pending_.t.back() > (*views_)[next_].utime - rig_.camera_time_offset + lookahead_) {
    Draw();
  }
}

void SurfaceMeter::Finish() {
  while (next_ < views_->size()) Draw();
}

void SurfaceMeter::Draw() {
  const MapView& view = (*views_)[next_++];
  const Utime t = view.utime - rig_.camera_time_offset;
  const auto until = [&](Utime last) {
    return static_cast<std::size_t>(std::upper_bound(pending_.t.begin(), pending_.t.end(), last) -
                                    pending_.t.begin());
  };
  const std::size_t n = until(t);
  surface_.Update(pending_.t.data(), pending_.x.data(), pending_.y.data(), n);
  DropFirst(n, &pending_);
  const SurfaceRenderer::Image image = renderer_.Render(
      surface_, {t, policy_.DecayUs(view.speed_px, 0), &pending_, 0, until(t + lookahead_), nullptr});
  const SE3 T_camera_map = (view.T_map_body * rig_.T_body_camera).Inverse();
  for (const Eigen::Vector3f& p : view.points) {
    Eigen::Vector2d pixel;
    if (!rig_.camera.Project(T_camera_map * p.cast<double>(), &pixel) ||
        !rig_.camera.Contains(pixel, kBorder))
      continue;
    const auto value = [&](double dx, double dy) {
      return Bilinear(image, rig_.camera.width, pixel + Eigen::Vector2d(dx, dy));
    };
    const double here = value(0, 0);
    ++total_.points;
    total_.sum += here;
    total_.sum_beside +=
        0.25 * (value(kBeside, 0) + value(-kBeside, 0) + value(0, kBeside) + value(0, -kBeside));
    ++total_.histogram[static_cast<std::size_t>(here) * SurfaceValues::kBins / 256];
  }
}

}  // namespace evit
