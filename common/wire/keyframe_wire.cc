#include "common/wire/keyframe_wire.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/wire/imu_wire.h"

namespace evit {
namespace {

std::int32_t Limited(std::int64_t value) {
  return static_cast<std::int32_t>(std::min<std::int64_t>(value, std::numeric_limits<std::int32_t>::max()));
}

}  // namespace

keyframe_t ToMessage(Keyframe k) {
  keyframe_t m{};
  m.utime = k.utime;
  m.seq = k.seq;
  m.previous_utime = k.previous_utime;
  m.high_rate = k.high_rate ? 1 : 0;
  m.n_events = Limited(k.n_events);
  m.decay_us = k.decay_us;
  m.lookahead_us = k.lookahead;
  m.width = k.width;
  m.height = k.height;
  m.encoding = static_cast<std::int8_t>(k.encoding);
  m.from_utime = k.from_utime;
  m.surface_size = k.width * k.height;
  m.surface = std::move(k.surface);
  PutSamples(k.imu, &m);
  m.imu_gap_us = Limited(k.imu_gap);
  return m;
}

TrackerFeedback ToFeedback(const tracker_mode_t& m) {
  TrackerFeedback f;
  f.mode = static_cast<TrackerFeedback::Mode>(m.mode);
  f.image_speed = m.image_speed;
  f.useful_interval = m.useful_interval_us;
  f.keyframe_stride = m.keyframe_stride;
  return f;
}

}  // namespace evit
