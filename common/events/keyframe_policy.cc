#include "common/events/keyframe_policy.h"

#include <algorithm>
#include <cmath>

#include "common/events/surface_renderer.h"

namespace evit {
namespace {

constexpr Utime kImuHole = 100'000;  // us between two samples: no keyframe in between

Utime Micros(double ms) { return std::max<Utime>(std::llround(ms * 1e3), 1); }

}  // namespace

KeyframePolicy::KeyframePolicy(const KeyframeOptions& keyframes, const SurfaceOptions& surface,
                               bool always_adaptive)
    : always_adaptive_(always_adaptive),
      n_event_(keyframes.n_event),
      min_events_(keyframes.min_events),
      n_imu_(keyframes.n_imu),
      relaxed_interval_(std::llround(1e3 * keyframes.relaxed_interval_ms)),
      max_interval_(Micros(keyframes.max_interval_ms)),
      high_rate_interval_(Micros(keyframes.bootstrap_interval_ms)),
      fixed_interval_(keyframes.fixed_rate_hz > 0 ? Micros(1e3 / keyframes.fixed_rate_hz) : 0),
      shown_decays_((surface.kind == SurfaceOptions::Kind::kSymmetric ? 2 : 1) *
                    VisibleUs(1, surface.truncation)),
      tail_px_(surface.tail_px),
      min_decay_us_(surface.min_decay_ms * 1e3),
      max_decay_us_(surface.max_decay_ms * 1e3),
      default_decay_us_(surface.default_decay_ms * 1e3) {}

std::optional<Utime> KeyframePolicy::Due(const Situation& s) const {
  if (fixed_interval_ > 0 || IsHighRate(s.mode)) {
    const Utime stamp = s.last + (fixed_interval_ > 0 ? fixed_interval_ : high_rate_interval_);
    if (stamp > s.imu) return std::nullopt;
    return stamp > s.imu_before && s.imu - s.imu_before > kImuHole ? s.imu : stamp;
  }
  const Utime waited = s.imu - s.last;
  // Whether the sample before would have been nearer to the interval does not matter: half a sample either
  // way.
  const double interval =
      s.stride * static_cast<double>(std::min({s.useful_interval, relaxed_interval_, max_interval_}));
  const bool useful =
      static_cast<double>(waited) + 0.5 * static_cast<double>(s.imu - s.imu_before) >= interval;
  const bool enough = useful && static_cast<double>(s.n_events) >= s.stride * static_cast<double>(n_event_) &&
                      s.n_imu >= s.stride * n_imu_;
  // A keyframe comes at last without events too: the IMU continues, and with it what is known of the state.
  const bool late = (waited >= max_interval_ && s.n_events >= min_events_) || waited >= 2 * max_interval_;
  if (enough || late) return s.imu;
  return std::nullopt;
}

double KeyframePolicy::DecayUs(double image_speed, double events_per_us) const {
  const double tail = image_speed > 0 ? tail_px_ / image_speed * 1e6 : default_decay_us_;
  const double enough =
      events_per_us > 0 ? static_cast<double>(n_event_) / (events_per_us * shown_decays_) : 0;
  return std::clamp(std::max(tail, enough), min_decay_us_, max_decay_us_);
}

}  // namespace evit
