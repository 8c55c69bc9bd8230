#pragma once

#include <chrono>
#include <deque>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/time/utime.h"

namespace evit::run {

/// Measures, as a listener on the bus, how long after the data a pose comes. Means something only where data
/// come in real time.
class LatencyProbe {
 public:
  /// `bus` must outlive this.
  LatencyProbe(Bus* bus, const Channels& channels);

  struct Summary {
    int count = 0;
    double p50_ms = 0, p99_ms = 0, max_ms = 0;
  };
  /// WINDOW_STATE after the packet with the last event that its surface shows; while tracking.
  Summary pose_after_events() const { return Summarize(after_events_); }
  /// WINDOW_STATE after the packet with the instant it stands for.
  Summary pose_after_stamp() const { return Summarize(after_stamp_); }
  /// BODY_POSE after the message with its IMU sample.
  Summary imu_pose() const { return Summarize(imu_pose_); }

 private:
  using Clock = std::chrono::steady_clock;
  /// When data up to a stamp had come.
  class Arrivals {
   public:
    void Add(Utime up_to);
    /// ms since all up to t had come; negative where it has not, or so long ago that it is forgotten.
    double MsSince(Utime t) const;

   private:
    struct Arrival {
      Utime up_to;
      Clock::time_point at;
    };
    std::deque<Arrival> arrivals_;
  };
  static Summary Summarize(std::vector<double> ms);
  static void Keep(double ms, std::vector<double>* into);

  Arrivals events_, imu_;
  Utime newest_ = 0;
  std::vector<double> after_events_, after_stamp_, imu_pose_;
};

}  // namespace evit::run
