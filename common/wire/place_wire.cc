#include "common/wire/place_wire.h"

#include <algorithm>

#include "common/wire/geometry_wire.h"

namespace evit {
namespace {

void PushPose(const SE3& pose, std::vector<std::vector<double>>* positions,
              std::vector<std::vector<double>>* orientations) {
  positions->push_back({pose.p.x(), pose.p.y(), pose.p.z()});
  orientations->push_back({pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()});
}

SE3 PoseOf(const std::vector<double>& p, const std::vector<double>& q) {
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(), {p[0], p[1], p[2]}};
}

// Messages with the fields of a prior.
template <typename Message>
void PutPrior(const PlacePrior& prior, Message* m) {
  m->near_radius = prior.near ? prior.near->radius : -1;
  if (prior.near) Put(prior.near->position, m->near_position);
  m->height_low = prior.height ? prior.height->low : 0;
  m->height_high = prior.height ? prior.height->high : -1;
  m->yaw = prior.heading ? prior.heading->yaw : 0;
  m->yaw_tolerance = prior.heading ? prior.heading->tolerance : -1;
}
template <typename Message>
PlacePrior PriorOf(const Message& m) {
  PlacePrior prior;
  if (m.near_radius >= 0) prior.near = {Eigen::Vector3d(m.near_position), m.near_radius};
  if (m.height_low <= m.height_high) prior.height = {m.height_low, m.height_high};
  if (m.yaw_tolerance >= 0) prior.heading = {m.yaw, m.yaw_tolerance};
  return prior;
}

}  // namespace

place_prior_t ToMessage(const PlacePrior& prior) {
  place_prior_t m{};
  PutPrior(prior, &m);
  return m;
}

PlacePrior FromMessage(const place_prior_t& message) { return PriorOf(message); }

place_query_t ToMessage(const PlaceQuery& query, const Rig& rig) {
  place_query_t m{};
  m.utime = query.t;
  m.attempt = query.number;
  PutPose(rig.T_body_camera, &m);
  m.camera = ToMessage(rig.camera);
  Put(query.up_body, m.up);
  m.everywhere = query.everywhere ? 1 : 0;
  PutPrior(query.prior, &m);
  m.n = static_cast<std::int32_t>(query.hypotheses.size());
  for (const SE3& pose : query.hypotheses) PushPose(pose, &m.hypothesis_position, &m.hypothesis_orientation);
  const cv::Mat surface = query.surface.isContinuous() ? query.surface : query.surface.clone();
  m.surface_size = static_cast<std::int32_t>(surface.total());
  m.surface.assign(surface.data, surface.data + surface.total());
  return m;
}

PlaceQuery FromMessage(const place_query_t& m) {
  PlaceQuery query;
  query.number = m.attempt;
  query.t = m.utime;
  query.surface = cv::Mat(m.camera.height, m.camera.width, CV_8UC1);
  std::copy(m.surface.begin(), m.surface.end(), query.surface.data);
  query.up_body = Eigen::Vector3d(m.up).normalized();
  query.everywhere = m.everywhere != 0;
  query.prior = PriorOf(m);
  for (std::size_t k = 0; k < m.hypothesis_position.size(); ++k)
    query.hypotheses.push_back(PoseOf(m.hypothesis_position[k], m.hypothesis_orientation[k]));
  return query;
}

Rig RigOf(const place_query_t& m) {
  Rig rig;
  rig.camera = FromMessage(m.camera);
  rig.T_body_camera = PoseOf(m);
  return rig;
}

places_t ToMessage(const std::vector<PlaceCandidate>& places) {
  places_t m{};
  m.n = static_cast<std::int32_t>(places.size());
  for (const PlaceCandidate& place : places) {
    PushPose(place.T_map_body, &m.position, &m.orientation);
    m.significance.push_back(place.significance);
    m.likeness.push_back(place.likeness);
    m.n_points.push_back(place.n_points);
  }
  return m;
}

std::vector<PlaceCandidate> PlacesOf(const places_t& m) {
  std::vector<PlaceCandidate> places;
  for (std::size_t k = 0; k < m.position.size(); ++k)
    places.push_back(
        {PoseOf(m.position[k], m.orientation[k]), m.significance[k], m.likeness[k], m.n_points[k]});
  return places;
}

}  // namespace evit
