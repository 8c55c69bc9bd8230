#pragma once

#include <cstdint>

#include "common/events/event.h"
#include "common/imu/imu_sample.h"
#include "common/time/ahead_guard.h"

namespace evit {

/// Stands before a StreamMerger and keeps one wrong stamp from spoiling what follows: the events of a packet
/// are put into order, and a packet, a packet's end or an IMU sample that lies more than AheadGuard::kAhead
/// ahead is dropped where what comes next does not.
class StreamGuard {
 public:
  struct Counters {
    std::int64_t events_ahead = 0, events_sorted = 0, imu_ahead = 0, imu = 0;
  };

  /// Calls use(events, watermark) for what is good now; as KeyframeBuilder::AddEvents takes them, and with an
  /// EventArray that `use` may take the memory of.
  template <typename Use>
  void AddEvents(EventArray events, Utime watermark, const Use& use) {
    Sort(&events);
    const auto pass = [&](Packet& p) { use(p.events, p.watermark); };
    const auto drop = [&](const Packet& p) {
      counters_.events_ahead += static_cast<std::int64_t>(p.events.size());
    };
    EventArray rest = CutAtJump(&events);
    if (rest.size() > 0 || events.size() == 0) {
      if (events.size() > 0) packets_.Push({events.t.front(), events, events.t.back()}, pass, drop);
      const Utime first = rest.size() > 0 ? rest.t.front() : watermark;
      packets_.Push({first, std::move(rest), watermark}, pass, drop);
    } else {
      const Utime first = events.t.front();
      packets_.Push({first, std::move(events), watermark}, pass, drop);
    }
  }
  /// Calls use(sample).
  template <typename Use>
  void AddImu(const ImuSample& sample, const Use& use) {
    ++counters_.imu;
    imu_.Push(sample, use, [&](const ImuSample&) { ++counters_.imu_ahead; });
  }
  template <typename UseEvents, typename UseImu>
  void Flush(const UseEvents& use_events, const UseImu& use_imu) {
    packets_.Flush([&](Packet& p) { use_events(p.events, p.watermark); });
    imu_.Flush(use_imu);
  }
  /// New streams begin.
  void Clear() {
    packets_.Clear();
    imu_.Clear();
  }
  const Counters& counters() const { return counters_; }

 private:
  struct Packet {
    Utime t;
    EventArray events;
    Utime watermark;
  };
  void Sort(EventArray* events);
  // Takes what comes after the first jump ahead off the events.
  static EventArray CutAtJump(EventArray* events);

  AheadGuard<Packet> packets_;
  AheadGuard<ImuSample> imu_;
  Counters counters_;
};

}  // namespace evit
