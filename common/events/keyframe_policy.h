#pragma once

#include <optional>

#include "common/events/keyframe_options.h"
#include "common/events/surface_options.h"
#include "common/imu/imu_sample.h"

namespace evit {

/// What the tracker says, as far as keyframes depend on it (tracker_mode_t).
struct TrackerFeedback {
  enum class Mode { kBootstrapping = 0, kTracking = 1, kLost = 2 };
  Mode mode = Mode::kBootstrapping;
  double image_speed = 0;      // pixels/s; 0: unknown
  double keyframe_stride = 1;  // in overload: so many times more events and samples for each keyframe
};

/// When a keyframe is due, and with which decay its surface is drawn. Pure: no state, no clock.
class KeyframePolicy {
 public:
  KeyframePolicy(const KeyframeOptions& keyframes, const SurfaceOptions& surface);

  struct Situation {
    TrackerFeedback::Mode mode = TrackerFeedback::Mode::kBootstrapping;
    double stride = 1;
    Utime last = 0;             // stamp of the last keyframe (or where the streams began)
    Utime imu = 0;              // stamp of the newest IMU sample, > last
    Utime imu_before = 0;       // of the one before it
    std::int64_t n_events = 0;  // in (last, imu]
    int n_imu = 0;              // samples in (last, imu]
  };
  /// Stamp of the keyframe that is due, in (last, imu]; none where none is.
  /// Tracking: the newest IMU sample's (paper Sec. III-B.1). Bootstrapping or lost: fixed intervals, also
  /// between IMU samples (so with a fixed rate), but not inside a hole in the IMU stream, where nothing can
  /// be interpolated.
  std::optional<Utime> Due(const Situation& situation) const;

  static bool IsHighRate(TrackerFeedback::Mode mode) { return mode != TrackerFeedback::Mode::kTracking; }

  /// us: the time an edge takes for `tail_px`, within the bounds of the settings.
  double DecayUs(double image_speed) const;

 private:
  std::int64_t n_event_, min_events_;
  int n_imu_;
  Utime max_interval_, high_rate_interval_, fixed_interval_;
  double tail_px_, min_decay_us_, max_decay_us_, default_decay_us_;
};

}  // namespace evit
