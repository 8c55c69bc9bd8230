#include "tools/run/log_span.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/bus/log_prefix.h"
#include "common/files/decimal_time.h"
#include "common/time/time_order.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::run {
namespace {

constexpr Utime kNever = std::numeric_limits<Utime>::max();
constexpr std::size_t kPackets = 300;           // of events, to see whether they can be true
constexpr Utime kLook = 10 * kMicrosPerSecond;  // of IMU samples, to see whether they can be true

// The messages of one channel; sensor time is read from them: logs of lcm-logger carry the host's clock.
struct Stream {
  const LogEntry *first = nullptr, *last = nullptr;

  template <typename Message>
  static Utime TimeOf(const LogReader& log, const LogEntry* entry, Utime otherwise) {
    std::vector<std::uint8_t> bytes;
    if (entry == nullptr) return otherwise;
    log.Read(*entry, &bytes);
    Message message;
    return DecodeChecked(bytes.data(), bytes.size(), &message) ? message.utime : otherwise;
  }
};

// Stamps of two clocks never meet.
void RequireOneClock(const RunJob& job, Utime events_begin, Utime events_end, Utime imu_begin,
                     Utime imu_end) {
  if (events_begin == kNever || imu_begin == kNever || events_end < 0 || imu_end < 0) return;
  if (events_begin <= imu_end && imu_begin <= events_end) return;
  throw std::runtime_error(
      job.log + ": EVENTS are stamped " + DecimalSeconds(events_begin) + " to " + DecimalSeconds(events_end) +
      " s, IMU " + DecimalSeconds(imu_begin) + " to " + DecimalSeconds(imu_end) +
      " s: two clocks; have both stamped by one (the sensor's, or the host's) and record again");
}

std::vector<ImuSample> FirstSamples(const LogReader& log, const std::string& channel) {
  std::vector<ImuSample> samples;
  std::vector<std::uint8_t> bytes;
  imu_batch_t message;
  for (const LogEntry& entry : log.entries()) {
    if (log.channel(entry) != channel) continue;
    log.Read(entry, &bytes);
    if (!DecodeChecked(bytes.data(), bytes.size(), &message)) continue;
    for (const ImuSample& s : SamplesOf(message)) {
      if (s.gyro.allFinite() && s.accel.allFinite()) samples.push_back(s);
    }
    if (!samples.empty() && samples.back().t - samples.front().t > kLook) break;
  }
  TimeOrderOptions strict;
  strict.strict = true;
  TimeOrderCounts counts;
  return InTimeOrder(samples, strict, &counts);
}

EventArray SomeEvents(const LogReader& log, const std::vector<const LogEntry*>& packets) {
  const std::size_t stride = 1 + packets.size() / kPackets;
  EventArray events;
  std::vector<std::uint8_t> bytes;
  event_packet_t message;
  for (std::size_t k = 0; k < packets.size(); k += stride) {
    log.Read(*packets[k], &bytes);
    if (DecodeChecked(bytes.data(), bytes.size(), &message)) AppendEvents(message, &events);
  }
  return events;
}

}  // namespace

LogSpan ReadLogSpan(const RunJob& job) {
  const LogReader log(job.log);
  if (log.trailing_bytes() > 0 && !job.tolerate.truncated) {
    throw std::runtime_error(
        job.log + ": is truncated or damaged after " + std::to_string(log.entries().size()) +
        " complete messages; make it again, or run the complete ones with --allow-truncated");
  }
  LogSpan span;
  span.lost_bytes = log.trailing_bytes();
  span.prefix = FindLogPrefix(job.log, log.channels(), job.play.log_prefix);
  const Channels channels(span.prefix);
  Stream events, imu;
  for (const LogEntry& entry : log.entries()) {
    const std::string& channel = log.channel(entry);
    Stream* stream = channel == channels.events ? &events : channel == channels.imu ? &imu : nullptr;
    if (stream == nullptr) continue;
    if (stream->first == nullptr) stream->first = &entry;
    stream->last = &entry;
  }
  if (events.first == nullptr) {
    throw std::runtime_error(job.log + ": holds no " + channels.events +
                             " messages; make it with `evit import`, or record them too");
  }
  const Utime imu_begin = Stream::TimeOf<imu_batch_t>(log, imu.first, kNever);
  const Utime events_begin = Stream::TimeOf<event_packet_t>(log, events.first, kNever);
  span.begin = span.log_begin = std::min(imu_begin, events_begin);
  const Utime events_end = Stream::TimeOf<event_packet_t>(log, events.last, -1);
  span.end = imu.last != nullptr ? Stream::TimeOf<imu_batch_t>(log, imu.last, -1) : events_end;
  RequireOneClock(job, events_begin, events_end, imu_begin, span.end);
  const Utime log_to_sensor = span.end - (imu.last != nullptr ? imu.last : events.last)->utime;
  if (job.play.seconds) {
    const Utime begin = span.begin;
    span.begin = begin + static_cast<Utime>(1e6 * job.play.seconds->first);
    span.end = std::min(span.end, begin + static_cast<Utime>(1e6 * job.play.seconds->second));
  }
  // The first keyframe needs both streams, where there are both.
  for (const Utime first : {imu_begin, events_begin}) {
    if (first != kNever) span.begin = std::max(span.begin, first);
  }
  if (span.begin >= span.end)
    throw std::runtime_error(job.log + ": contains no data in the part that --seconds selects");
  // The number of events follows from a message's length: nothing else has to be read.
  const std::int64_t bare = event_packet_t{}.getEncodedSize();
  std::vector<const LogEntry*> packets;
  for (const LogEntry& entry : log.entries()) {
    const Utime t = entry.utime + log_to_sensor;
    if (log.channel(entry) != channels.events || t < span.begin || t > span.end) continue;
    span.n_events += std::max<std::int64_t>(0, (entry.size - bare) / 9);
    packets.push_back(&entry);
  }
  span.events = SomeEvents(log, packets);
  span.imu = FirstSamples(log, channels.imu);
  return span;
}

}  // namespace evit::run
