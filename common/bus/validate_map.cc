// Questions to the map, and its answers.
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/bus/field_checks.h"
#include "common/bus/validate.h"

namespace evit {
namespace {

void CheckCamera(const camera_t& camera, FieldChecks* check) {
  check->That(camera.model == "plumb_bob" || camera.model == "equidistant", "camera.model is unknown")
      .That(camera.width > 0 && camera.width <= kMaxImageSide, "camera.width is out of range")
      .That(camera.height > 0 && camera.height <= kMaxImageSide, "camera.height is out of range")
      .Finite("camera.fx", camera.fx)
      .Finite("camera.fy", camera.fy)
      .That(camera.fx > 0 && camera.fy > 0, "the focal length is not positive")
      .Finite("camera.cx", camera.cx)
      .Finite("camera.cy", camera.cy)
      .Finite("camera.distortion", camera.distortion);
}

void CheckUnit(const char* name, const std::vector<double>& q, FieldChecks* check) {
  double numbers[4];
  std::copy_n(q.data(), 4, numbers);
  check->Unit(name, numbers);
}

// Fields of what is known of a place.
template <typename Message>
void CheckPrior(const Message& m, FieldChecks* check) {
  check->Finite("near_position", m.near_position)
      .Finite("near_radius", m.near_radius)
      .Finite("height_low", m.height_low)
      .Finite("height_high", m.height_high)
      .Finite("yaw", m.yaw)
      .Finite("yaw_tolerance", m.yaw_tolerance);
}

}  // namespace

bool Validate(const map_points_t& m, std::string* why) {
  bool in_map = true;
  for (const std::int32_t id : m.id) in_map = in_map && id >= 0 && id < m.map_size;
  return FieldChecks(why)
      .Stamp(m)
      .That(m.query_seq >= 0, "query_seq is negative")
      .That(m.map_size >= 0, "map_size is negative")
      .That(m.n <= m.n_visible && m.n_visible <= m.map_size, "n <= n_visible <= map_size does not hold")
      .That(in_map, "an id is outside the map")
      .Finite("x", m.x.data(), m.x.size())
      .Finite("y", m.y.data(), m.y.size())
      .Finite("z", m.z.data(), m.z.size())
      .ok();
}

bool Validate(const map_query_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m).Pose(m);
  CheckCamera(m.camera, &check);
  return check.Finite("margin_px", m.margin_px)
      .That(m.margin_px >= 0, "margin_px is negative")
      .Finite("min_depth", m.min_depth)
      .Finite("max_depth", m.max_depth)
      .That(m.min_depth >= 0 && m.min_depth < m.max_depth,
            "min_depth is not below max_depth, or out of range")
      .That(m.occlusion == 0 || m.occlusion == 1, "occlusion is neither 0 nor 1")
      .That(m.max_points >= 0 && m.max_points <= kMaxMapPoints, "max_points is out of range")
      .ok();
}

bool Validate(const map_view_t& m, std::string* why) {
  return FieldChecks(why)
      .Stamp(m)
      .That(m.query_seq >= 0, "query_seq is negative")
      .That(m.width > 0 && m.width <= kMaxImageSide, "width is out of range")
      .That(m.height > 0 && m.height <= kMaxImageSide, "height is out of range")
      .That(std::int64_t{m.width} * m.height == m.size, "size is not width * height")
      .Finite("min_depth", m.min_depth)
      .That(m.min_depth > 0, "min_depth is not positive")
      .ok();
}

bool Validate(const place_prior_t& m, std::string* why) {
  FieldChecks check(why);
  CheckPrior(m, &check.Stamp(m));
  return check.ok();
}

bool Validate(const place_query_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m).Pose(m);
  CheckCamera(m.camera, &check);
  const double up = std::sqrt(m.up[0] * m.up[0] + m.up[1] * m.up[1] + m.up[2] * m.up[2]);
  check
      .That(std::abs(up - 1) <= 1e-3, "up is not a unit vector")  // false for NaN
      .That(m.everywhere == 0 || m.everywhere == 1, "everywhere is neither 0 nor 1")
      .That(m.attempt >= 0 && m.attempt < kMaxSequence, "attempt is out of range")
      .Finite("hypothesis_position", m.hypothesis_position)
      .That(std::int64_t{m.camera.width} * m.camera.height == m.surface_size,
            "surface_size is not camera.width * camera.height");
  CheckPrior(m, &check);
  for (const std::vector<double>& q : m.hypothesis_orientation)
    CheckUnit("hypothesis_orientation", q, &check);
  return check.ok();
}

bool Validate(const places_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m)
      .That(m.query_seq >= 0, "query_seq is negative")
      .Finite("position", m.position)
      .Finite("significance", m.significance.data(), m.significance.size())
      .Finite("likeness", m.likeness.data(), m.likeness.size());
  for (const std::vector<double>& q : m.orientation) CheckUnit("orientation", q, &check);
  for (const std::int32_t n : m.n_points) check.That(n >= 0, "n_points is negative");
  return check.ok();
}

bool Validate(const view_query_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m).Pose(m);
  CheckCamera(m.camera, &check);
  bool straight = true;
  for (const double k : m.camera.distortion) straight = straight && k == 0;
  return check.That(straight, "camera.distortion is not 0")
      .Finite("min_depth", m.min_depth)
      .Finite("max_depth", m.max_depth)
      .That(m.min_depth > 0 && m.min_depth < m.max_depth, "min_depth is not below max_depth, or out of range")
      .ok();
}

}  // namespace evit
