#include "common/bus/validate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/bus/field_checks.h"

namespace evit {

namespace {

template <typename Pose>
void CheckPose(const Pose& m, FieldChecks* check) {
  check->Finite("position", m.position).Unit("orientation", m.orientation);
}

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

bool IsMode(int mode) { return mode >= tracker_mode_t::BOOTSTRAPPING && mode <= tracker_mode_t::LOST; }

}  // namespace

bool Validate(const body_pose_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m);
  CheckPose(m, &check);
  return check.Finite("velocity", m.velocity).ok();
}

bool Validate(const credit_t& m, std::string* why) {
  return FieldChecks(why)
      .Stamp(m)
      .That(!m.consumer.empty(), "consumer is empty")
      .That(m.next_events_seq >= -1 && m.next_imu_seq >= -1, "a next seq is below -1")
      .ok();
}

bool Validate(const event_packet_t& m, std::string* why) {
  // Without branches, so that the compiler makes vectors of it: millions of events come this way each second.
  std::int32_t unsorted = 0;
  for (std::int32_t i = 1; i < m.n; ++i) unsorted |= static_cast<int>(m.dt_us[i] < m.dt_us[i - 1]);
  int coordinates = 0;
  for (std::int32_t i = 0; i < m.n; ++i) coordinates |= m.x[i] | m.y[i];
  int polarities = 0;
  for (std::int32_t i = 0; i < m.n; ++i) polarities |= m.polarity[i];
  return FieldChecks(why)
      .Stamp(m)
      .That(m.n == 0 || m.dt_us[0] == 0, "dt_us[0] is not 0")
      .That(unsorted == 0, "dt_us decreases")
      .That(coordinates >= 0, "a pixel coordinate is negative")
      .That(polarities <= 1, "a polarity is neither 0 nor 1")
      .ok();
}

bool Validate(const imu_batch_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m);
  if (m.n > 0) {
    check.Time("sample_utime", m.sample_utime.front())
        .Time("sample_utime", m.sample_utime.back())
        .That(m.sample_utime.front() == m.utime, "utime is not that of the first sample");
  }
  return check.Increasing("sample_utime", m.sample_utime)
      .Finite("gyro", m.gyro)
      .Finite("accel", m.accel)
      .ok();
}

bool Validate(const keyframe_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m)
      .Time("previous_utime", m.previous_utime)
      .That(m.previous_utime <= m.utime, "previous_utime is after utime")
      .That(m.high_rate == 0 || m.high_rate == 1, "high_rate is neither 0 nor 1")
      .That(m.n_events >= 0, "n_events is negative")
      .Finite("decay_us", m.decay_us)
      .That(m.decay_us > 0, "decay_us is not positive")
      .That(m.lookahead_us >= 0 && m.lookahead_us <= kMaxTime, "lookahead_us is negative")
      .That(m.width > 0 && m.width <= kMaxImageSide, "width is out of range")
      .That(m.height > 0 && m.height <= kMaxImageSide, "height is out of range")
      .That(m.encoding == keyframe_t::TIME_SURFACE || m.encoding == keyframe_t::EVENT_COUNT,
            "encoding is unknown")
      .Time("from_utime", m.from_utime)
      .That(m.from_utime <= m.utime, "from_utime is after utime")
      .That(std::int64_t{m.width} * m.height == m.surface_size, "surface_size is not width * height")
      .That(m.imu_gap_us >= 0, "imu_gap_us is negative")
      .Increasing("imu_utime", m.imu_utime)
      .That(m.n_imu == 0 || (m.imu_utime.front() >= m.previous_utime && m.imu_utime.back() <= m.utime),
            "imu_utime leaves the interval from previous_utime to utime")
      .Finite("gyro", m.gyro)
      .Finite("accel", m.accel);
  return check.ok();
}

bool Validate(const map_points_t& m, std::string* why) {
  bool in_map = true;
  for (const std::int32_t id : m.id) in_map = in_map && id >= 0 && id < m.map_size;
  return FieldChecks(why)
      .Stamp(m)
      .That(m.query_seq >= 0, "query_seq is negative")
      .That(m.map_size >= 0, "map_size is negative")
      .That(m.n <= m.n_visible && m.n_visible <= m.map_size, "n <= n_visible <= map_size does not hold")
      .That(in_map, "an id is outside the map")
      .Finite("xyz", m.xyz)
      .ok();
}

bool Validate(const map_query_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m);
  CheckPose(m, &check);
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

bool Validate(const place_query_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m);
  CheckPose(m, &check);
  CheckCamera(m.camera, &check);
  const double up = std::sqrt(m.up[0] * m.up[0] + m.up[1] * m.up[1] + m.up[2] * m.up[2]);
  check
      .That(std::abs(up - 1) <= 1e-3, "up is not a unit vector")  // false for NaN
      .That(m.everywhere == 0 || m.everywhere == 1, "everywhere is neither 0 nor 1")
      .That(m.attempt >= 0 && m.attempt < kMaxSequence, "attempt is out of range")
      .Finite("near_position", m.near_position)
      .Finite("near_radius", m.near_radius)
      .Finite("height_low", m.height_low)
      .Finite("height_high", m.height_high)
      .Finite("yaw", m.yaw)
      .Finite("yaw_tolerance", m.yaw_tolerance)
      .Finite("hypothesis_position", m.hypothesis_position)
      .That(std::int64_t{m.camera.width} * m.camera.height == m.surface_size,
            "surface_size is not camera.width * camera.height");
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

bool Validate(const replay_control_t& m, std::string* why) {
  return FieldChecks(why)
      .Stamp(m)
      .That(m.command >= replay_control_t::PAUSE && m.command <= replay_control_t::SPEED,
            "command is unknown")
      .Time("seek_utime", m.seek_utime)
      .Finite("speed", m.speed)
      .That(m.speed >= 0 && m.speed <= 1000, "speed is not 0..1000")
      .ok();
}

bool Validate(const service_status_t& m, std::string* why) {
  return FieldChecks(why)
      .Stamp(m)
      .That(!m.service.empty() && !m.state.empty(), "service or state is empty")
      .That(m.progress == -1 || (m.progress >= 0 && m.progress <= 1), "progress is neither -1 nor 0..1")
      .That(m.granted_receive_buffer >= 0, "granted_receive_buffer is negative")
      .Finite("timing_ms", m.timing_ms.data(), m.timing_ms.size())
      .ok();
}

bool Validate(const stream_end_t& m, std::string* why) {
  return FieldChecks(why)
      .Stamp(m)
      .That(m.n_events_messages >= 0 && m.n_imu_messages >= 0, "a number of messages is negative")
      .ok();
}

bool Validate(const tracker_mode_t& m, std::string* why) {
  return FieldChecks(why)
      .Stamp(m)
      .That(m.keyframe_seq >= -1, "keyframe_seq is below -1")
      .That(IsMode(m.mode), "mode is unknown")
      .That(m.resend == 0 || m.resend == 1, "resend is neither 0 nor 1")
      .Finite("image_speed", m.image_speed)
      .That(m.image_speed >= 0, "image_speed is negative")
      .That(m.keyframe_stride >= 1 && m.keyframe_stride <= 100, "keyframe_stride is not 1..100")
      .ok();
}

bool Validate(const view_query_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m);
  CheckPose(m, &check);
  CheckCamera(m.camera, &check);
  bool straight = true;
  for (const double k : m.camera.distortion) straight = straight && k == 0;
  return check.That(straight, "camera.distortion is not 0")
      .Finite("min_depth", m.min_depth)
      .Finite("max_depth", m.max_depth)
      .That(m.min_depth > 0 && m.min_depth < m.max_depth, "min_depth is not below max_depth, or out of range")
      .ok();
}

bool Validate(const window_state_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m)
      .That(m.keyframe_seq >= 0, "keyframe_seq is negative")
      .That(IsMode(m.mode), "mode is unknown");
  for (std::size_t i = 0; i < m.node.size(); ++i) {
    const node_state_t& node = m.node[i];
    CheckPose(node, &check);
    check.Time("node.utime", node.utime)
        .That(i == 0 || m.node[i - 1].utime < node.utime, "the nodes' utime does not increase")
        .Finite("velocity", node.velocity)
        .Finite("gyro_bias", node.gyro_bias)
        .Finite("accel_bias", node.accel_bias);
  }
  return check.Finite("covariance", m.covariance)
      .That(m.n_points >= 0, "n_points is negative")
      .That(m.inlier_share >= 0 && m.inlier_share <= 1, "inlier_share is not 0..1")
      .Finite("mean_cost", m.mean_cost)
      .That(m.lookahead_us >= 0 && m.lookahead_us <= kMaxTime, "lookahead_us is negative")
      .Finite("solve_ms", m.solve_ms)
      .Finite("total_ms", m.total_ms)
      .ok();
}

}  // namespace evit
