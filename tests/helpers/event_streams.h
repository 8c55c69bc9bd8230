#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/events/event.h"
#include "common/events/keyframe_builder.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

/// Small streams for tests.
namespace evit::test {

constexpr int kWidth = 64, kHeight = 48;

inline Rig SmallRig() {
  Rig rig;
  rig.camera.width = kWidth;
  rig.camera.height = kHeight;
  rig.imu_noise = {1e-3, 1e-2, 1e-5, 1e-4};
  rig.imu_rate_hz = 200;
  return rig;
}

inline KeyframeBuilder::Options SmallOptions() {
  KeyframeBuilder::Options options;
  KeyframeOptions& k = options.keyframes;
  k.n_event = 1500;
  k.n_imu = 4;
  k.max_interval_ms = 60;
  k.min_events = 200;
  k.fixed_rate_hz = 0;
  k.bootstrap_interval_ms = 7.3;  // between IMU samples
  SurfaceOptions& s = options.surface;
  s.kind = SurfaceOptions::Kind::kSymmetric;
  s.lookahead_ms = 10;
  s.tail_px = 3;
  s.min_decay_ms = 2;
  s.max_decay_ms = 30;
  s.default_decay_ms = 8;
  s.truncation = 20;
  s.blur_sigma_px = 1;
  s.support_filter = true;
  s.hot_pixel_rate_hz = 100;
  s.lag_px = 0;
  return options;
}

/// Random events at `rate` per second; some share a stamp.
inline EventArray RandomStream(Utime begin, Utime end, double rate, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Utime> times(static_cast<std::size_t>(rate * ToSeconds(end - begin)));
  for (Utime& t : times) t = begin + static_cast<Utime>(random() % (end - begin)) / 20 * 20;
  std::sort(times.begin(), times.end());
  EventArray events;
  for (const Utime t : times) {
    const bool defect = random() % 50 == 0;
    const std::uint32_t r = random();
    events.push_back(t, defect ? 5 : r % kWidth, defect ? 7 : (r >> 8) % kHeight, (r >> 16) % 2);
  }
  return events;
}

inline std::vector<ImuSample> ImuStream(Utime begin, Utime end, Utime period = 5'000) {
  std::vector<ImuSample> samples;
  for (Utime t = begin; t <= end; t += period) {
    const double s = ToSeconds(t);
    samples.push_back({t, {0.3 * std::sin(5 * s), 0.2, -0.1 * std::cos(3 * s)}, {std::sin(2 * s), 0.5, 9.8}});
  }
  return samples;
}

inline EventArray Slice(const EventArray& e, std::size_t begin, std::size_t end) {
  EventArray out;
  for (std::size_t i = begin; i < end; ++i) out.push_back(e.t[i], e.x[i], e.y[i], e.p[i]);
  return out;
}

}  // namespace evit::test
