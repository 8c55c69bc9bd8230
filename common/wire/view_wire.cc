#include "common/wire/view_wire.h"

#include <algorithm>
#include <cstddef>

#include "common/wire/geometry_wire.h"

namespace evit {
namespace {

constexpr float kPerLog = 4096;
constexpr double kMost = 65535;  // the largest inverse depth there is

// To the nearest; std::lround is a call for each number.
int Rounded(float v) { return static_cast<int>(v + (v < 0 ? -0.5F : 0.5F)); }

}  // namespace

view_query_t ToMessage(const ViewQuery& q) {
  view_query_t m{};
  PutPose(q.T_map_camera, &m);
  m.camera = ToMessage(q.camera);
  m.min_depth = q.min_depth;
  m.max_depth = q.max_depth;
  return m;
}

ViewQuery FromMessage(const view_query_t& m) {
  ViewQuery q;
  q.T_map_camera = PoseOf(m);
  q.camera = FromMessage(m.camera);
  q.camera.model = Camera::Model::kPlumbBob;  // without distortion: a plain pinhole
  q.min_depth = m.min_depth;
  q.max_depth = m.max_depth;
  return q;
}

map_view_t ToMessage(const PhotometricView& view) {
  map_view_t m{};
  m.width = view.query.camera.width;
  m.height = view.query.camera.height;
  m.size = m.width * m.height;
  m.min_depth = view.query.min_depth;
  m.log_intensity.resize(view.log_intensity.size());
  m.inverse_depth.resize(view.inverse_depth.size());
  for (std::size_t k = 0; k < view.log_intensity.size(); ++k) {
    m.log_intensity[k] =
        static_cast<std::int16_t>(Rounded(std::clamp(view.log_intensity[k] * kPerLog, -32768.0F, 32767.0F)));
  }
  const auto scale = static_cast<float>(kMost * view.query.min_depth);
  for (std::size_t k = 0; k < view.inverse_depth.size(); ++k) {
    const float v = view.inverse_depth[k];
    const float units = v > 0 ? std::clamp(v * scale, 1.0F, static_cast<float>(kMost)) : 0.0F;
    m.inverse_depth[k] = static_cast<std::int16_t>(static_cast<std::uint16_t>(Rounded(units)));
  }
  return m;
}

PhotometricView FromMessage(const map_view_t& m, const ViewQuery& query) {
  PhotometricView view;
  view.query = query;
  view.log_intensity.resize(m.log_intensity.size());
  view.inverse_depth.resize(m.inverse_depth.size());
  std::transform(m.log_intensity.begin(), m.log_intensity.end(), view.log_intensity.begin(),
                 [](std::int16_t v) { return static_cast<float>(v) / kPerLog; });
  const auto unit = static_cast<float>(1 / (kMost * m.min_depth));
  std::transform(m.inverse_depth.begin(), m.inverse_depth.end(), view.inverse_depth.begin(),
                 [unit](std::int16_t v) { return unit * static_cast<float>(static_cast<std::uint16_t>(v)); });
  return view;
}

}  // namespace evit
