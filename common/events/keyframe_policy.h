#pragma once

#include <cstdint>
#include <optional>

#include "common/events/keyframe_options.h"
#include "common/events/surface_options.h"
#include "common/events/tracker_feedback.h"
#include "common/time/utime.h"

namespace evit {

/// When a keyframe is due, and with which decay its surface is drawn. Pure: no state, no clock.
class KeyframePolicy {
 public:
  /// `always_adaptive`: never at the high rate, whatever the tracker's mode (EVPT).
  KeyframePolicy(const KeyframeOptions& keyframes, const SurfaceOptions& surface,
                 bool always_adaptive = false);

  struct Situation {
    TrackerFeedback::Mode mode = TrackerFeedback::Mode::kBootstrapping;
    double stride = 1;
    Utime useful_interval = 0;  // us
    Utime last = 0;             // stamp of the last keyframe (or where the streams began)
    Utime imu = 0;              // stamp of the newest IMU sample, > last
    Utime imu_before = 0;       // of the one before it
    std::int64_t n_events = 0;  // in (last, imu]
    int n_imu = 0;              // samples in (last, imu]
  };
  /// Stamp of the keyframe that is due, in (last, imu]; nothing if none is due.
  /// Tracking: the newest IMU sample's (paper Sec. III-B.1), not before the useful interval is over.
  /// Bootstrapping or lost: fixed intervals, also between IMU samples (so with a fixed rate), but not inside
  /// a hole in the IMU stream, where nothing can be interpolated.
  std::optional<Utime> Due(const Situation& situation) const;

  bool IsHighRate(TrackerFeedback::Mode mode) const {
    return !always_adaptive_ && mode != TrackerFeedback::Mode::kTracking;
  }

  /// us: the time an edge takes for `tail_px`, or in which a surface shows as many events as a keyframe asks
  /// for at least (a few events, stamped coarsely, say nothing along a narrow tail), whichever is longer;
  /// within the bounds of the settings. `events_per_us`: 0 where it is not known.
  double DecayUs(double image_speed, double events_per_us) const;

 private:
  bool always_adaptive_;
  std::int64_t n_event_, min_events_;
  int n_imu_;
  Utime relaxed_interval_, max_interval_, high_rate_interval_, fixed_interval_;
  double shown_decays_;  // a surface shows the events of so many decays, on both sides of its stamp together
  double tail_px_, min_decay_us_, max_decay_us_, default_decay_us_;
};

}  // namespace evit
