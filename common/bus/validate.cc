#include "common/bus/validate.h"

#include "common/bus/field_checks.h"

namespace evit {
namespace {

bool IsMode(int mode) { return mode >= tracker_mode_t::BOOTSTRAPPING && mode <= tracker_mode_t::LOST; }

}  // namespace

bool Validate(const body_pose_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m).Pose(m);
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
      .That(m.useful_interval_us >= 0 && m.useful_interval_us <= 1'000'000,
            "useful_interval_us is not 0..1000000")
      .That(m.keyframe_stride >= 1 && m.keyframe_stride <= 100, "keyframe_stride is not 1..100")
      .ok();
}

bool Validate(const window_state_t& m, std::string* why) {
  FieldChecks check(why);
  check.Stamp(m)
      .That(m.keyframe_seq >= 0, "keyframe_seq is negative")
      .That(IsMode(m.mode), "mode is unknown");
  for (std::size_t i = 0; i < m.node.size(); ++i) {
    const node_state_t& node = m.node[i];
    check.Pose(node)
        .Time("node.utime", node.utime)
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
