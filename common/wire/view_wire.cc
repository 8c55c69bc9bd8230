#include "common/wire/view_wire.h"

#include <algorithm>
#include <cmath>

#include "common/wire/geometry_wire.h"

namespace evit {
namespace {

constexpr float kPerLog = 4096;
constexpr double kMost = 65535;  // the largest inverse depth there is

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
  m.log_intensity.reserve(view.log_intensity.size());
  m.inverse_depth.reserve(view.inverse_depth.size());
  for (const float v : view.log_intensity) {
    m.log_intensity.push_back(
        static_cast<std::int16_t>(std::lround(std::clamp(v * kPerLog, -32768.0F, 32767.0F))));
  }
  const auto scale = static_cast<float>(kMost * view.query.min_depth);
  for (const float v : view.inverse_depth) {
    const float units = v > 0 ? std::clamp(v * scale, 1.0F, static_cast<float>(kMost)) : 0.0F;
    m.inverse_depth.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(std::lround(units))));
  }
  return m;
}

PhotometricView FromMessage(const map_view_t& m, const ViewQuery& query) {
  PhotometricView view;
  view.query = query;
  view.log_intensity.reserve(m.log_intensity.size());
  view.inverse_depth.reserve(m.inverse_depth.size());
  for (const std::int16_t v : m.log_intensity) view.log_intensity.push_back(static_cast<float>(v) / kPerLog);
  const auto unit = static_cast<float>(1 / (kMost * m.min_depth));
  for (const std::int16_t v : m.inverse_depth) {
    view.inverse_depth.push_back(unit * static_cast<float>(static_cast<std::uint16_t>(v)));
  }
  return view;
}

}  // namespace evit
