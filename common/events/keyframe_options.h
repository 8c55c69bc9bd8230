#pragma once

namespace evit {

/// When a keyframe is made (paper Sec. III-B.1): both minima reached. Its stamp is the newest IMU sample's.
struct KeyframeOptions {
  int n_event = 8'000;  // events since the last keyframe, at least
  int n_imu = 4;        // IMU samples since the last keyframe, at least (20 ms at 200 Hz)
  double relaxed_interval_ms =
      30;                        // and as long as the tracker says that more of them tell little, up to this
  double max_interval_ms = 100;  // a keyframe at the latest after this: IMU drift stays small in slow motion
  int min_events = 500;          // events that even such a keyframe needs; fewer are hardly more than noise
  double fixed_rate_hz = 0;      // 0: adaptive, as above; else frames at this rate
  double bootstrap_interval_ms = 10;  // between the high-rate frames of bootstrapping
};

}  // namespace evit
