#include "services/frame_builder/keyframe_message.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace evit {

keyframe_t ToMessage(Keyframe k) {
  keyframe_t m{};
  m.utime = k.utime;
  m.seq = k.seq;
  m.previous_utime = k.previous_utime;
  m.high_rate = k.high_rate ? 1 : 0;
  m.n_events =
      static_cast<std::int32_t>(std::min<std::int64_t>(k.n_events, std::numeric_limits<std::int32_t>::max()));
  m.decay_us = k.decay_us;
  m.lookahead_us = k.lookahead;
  m.width = k.width;
  m.height = k.height;
  m.encoding = k.event_count ? keyframe_t::EVENT_COUNT : keyframe_t::TIME_SURFACE;
  m.from_utime = k.from_utime;
  m.surface_size = k.width * k.height;
  m.surface = std::move(k.surface);
  m.n_imu = static_cast<std::int32_t>(k.imu.size());
  for (const ImuSample& s : k.imu) {
    m.imu_utime.push_back(s.t);
    m.gyro.push_back({s.gyro.x(), s.gyro.y(), s.gyro.z()});
    m.accel.push_back({s.accel.x(), s.accel.y(), s.accel.z()});
  }
  m.imu_gap_us =
      static_cast<std::int32_t>(std::min<Utime>(k.imu_gap, std::numeric_limits<std::int32_t>::max()));
  return m;
}

TrackerFeedback ToFeedback(const tracker_mode_t& m) {
  TrackerFeedback f;
  f.mode = static_cast<TrackerFeedback::Mode>(m.mode);
  f.image_speed = m.image_speed;
  f.keyframe_stride = m.keyframe_stride;
  return f;
}

std::vector<ImuSample> ToSamples(const imu_batch_t& m) {
  std::vector<ImuSample> samples;
  samples.reserve(m.n);
  for (int i = 0; i < m.n; ++i) {
    samples.push_back(
        {m.sample_utime[i], Eigen::Vector3d(m.gyro[i].data()), Eigen::Vector3d(m.accel[i].data())});
  }
  return samples;
}

}  // namespace evit
