#pragma once

#include <deque>
#include <limits>

#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit {

/// Brings events and IMU samples into one order of time, whatever the order they arrive in: an IMU sample is
/// next only when all events up to its stamp are known. Keeps events that are still needed.
///
/// Bad times: what is late by up to kMaxDisorder is dropped and counted; a jump further back means that the
/// clock was set, and everything restarts (Counters::resets).
class StreamMerger {
 public:
  static constexpr Utime kMaxDisorder = 1'000'000;                  // us
  static constexpr Utime kImuLead = 50'000;                         // us
  static constexpr Utime kEnd = std::numeric_limits<Utime>::max();  // watermark after the last event
  static constexpr std::size_t kMaxImu = 100'000;

  struct Counters {
    std::int64_t events_outside = 0;  // pixel not in the image
    std::int64_t events_late = 0;
    std::int64_t imu_late = 0;     // duplicates too
    std::int64_t imu_invalid = 0;  // not finite, or beyond what the sensor can read
    std::int64_t resets = 0;
  };

  /// `wait_for_events`: never use an IMU sample before the events up to it are known; false (real time):
  /// continue when the IMU is kImuLead ahead. `time_offset` (us) is added to event stamps.
  /// IMU readings beyond `noise`'s ranges are errors.
  StreamMerger(int width, int height, bool wait_for_events, Utime time_offset, const ImuNoise& noise = {});

  /// Sorted events, then: no event before `watermark` is still to come (event clock; last event's stamp will
  /// do).
  /// Returns false where the clock jumped back: all kept was dropped before these were added.
  bool AddEvents(const EventArray& events, Utime watermark);
  bool AddImu(const ImuSample& sample);
  /// No more events will come.
  void Flush() { watermark_ = kEnd; }
  void Clear();

  /// The next IMU sample, where all events up to it are known; else null.
  const ImuSample* NextImu() const;
  void PopImu() { imu_.pop_front(); }
  /// Whether all events up to t, t included, are known.
  bool Knows(Utime t) const { return t < Watermark(); }

  /// Events kept, in time order. Positions count from the stream's begin and stay valid while kept.
  const EventArray& events() const { return events_; }
  std::int64_t first() const { return dropped_ + static_cast<std::int64_t>(head_); }
  std::size_t IndexOf(std::int64_t position) const { return static_cast<std::size_t>(position - dropped_); }
  /// Position after the newest event kept.
  std::int64_t end() const { return dropped_ + static_cast<std::int64_t>(events_.size()); }
  /// us: of the event at a position from first() on, before end().
  Utime StampAt(std::int64_t position) const { return events_.t[IndexOf(position)]; }
  /// Position after the last event with a stamp <= t.
  std::int64_t PositionAfter(Utime t) const;
  /// Events before this position are not needed any more.
  void Release(std::int64_t position);
  std::size_t kept() const { return events_.size() - head_; }

  const Counters& counters() const { return counters_; }
  bool has_events() const { return has_events_; }
  Utime first_event() const { return first_event_; }
  Utime newest_event() const { return newest_event_; }  // us; 0: none has come
  bool has_imu() const { return has_imu_; }
  bool ended() const { return watermark_ == kEnd; }

 private:
  bool IsPlain(const EventArray& events) const;
  void Append(const EventArray& events);
  void Filter(const EventArray& events);

  Utime Watermark() const;

  int width_, height_;
  bool wait_for_events_;
  Utime offset_;
  ImuNoise noise_;
  EventArray events_;
  std::size_t head_ = 0;      // first event kept
  std::int64_t dropped_ = 0;  // position of events_[0]
  bool has_events_ = false, has_imu_ = false;
  Utime first_event_ = 0, newest_event_ = 0, watermark_ = std::numeric_limits<Utime>::min(), last_imu_ = 0;
  std::deque<ImuSample> imu_;
  Counters counters_;
};

}  // namespace evit
