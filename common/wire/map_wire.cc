#include "common/wire/map_wire.h"

#include "common/wire/geometry_wire.h"

namespace evit {

map_query_t ToMessage(const VisibilityQuery& q) {
  map_query_t m{};
  PutPose(q.T_map_camera, &m);
  m.camera = ToMessage(q.camera);
  m.margin_px = q.margin_px;
  m.min_depth = q.min_depth;
  m.max_depth = q.max_depth;
  m.occlusion = q.occlusion ? 1 : 0;
  m.max_points = q.max_points;
  m.seed = static_cast<std::int64_t>(q.seed);
  return m;
}

VisibilityQuery FromMessage(const map_query_t& m) {
  VisibilityQuery q;
  q.T_map_camera = PoseOf(m);
  q.camera = FromMessage(m.camera);
  q.margin_px = m.margin_px;
  q.min_depth = m.min_depth;
  q.max_depth = m.max_depth;
  q.occlusion = m.occlusion != 0;
  q.max_points = m.max_points;
  q.seed = static_cast<std::uint64_t>(m.seed);
  return q;
}

map_points_t ToMessage(const VisibilityAnswer& answer, const PointMap& map) {
  map_points_t m{};
  m.map_size = static_cast<std::int64_t>(map.points.size());
  m.n_visible = answer.n_visible;
  m.n = static_cast<std::int32_t>(answer.ids.size());
  m.id = answer.ids;
  for (std::vector<float>* v : {&m.x, &m.y, &m.z}) v->resize(answer.ids.size());
  for (std::size_t k = 0; k < answer.ids.size(); ++k) {
    const Eigen::Vector3f& p = map.points[answer.ids[k]];
    m.x[k] = p.x(), m.y[k] = p.y(), m.z[k] = p.z();
  }
  return m;
}

std::vector<Eigen::Vector3f> PointsOf(const map_points_t& m) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(m.x.size());
  for (std::size_t k = 0; k < m.x.size(); ++k) points.emplace_back(m.x[k], m.y[k], m.z[k]);
  return points;
}

}  // namespace evit
