#include "tools/doctor/recorded_data.h"

#include <optional>
#include <stdexcept>

#include "common/bus/codec.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::doctor {
namespace {

// A channel by its name, or by its name behind the only prefix there is; empty where there is none.
std::string FindChannel(const LogReader& log, const std::string& path, const std::string& name) {
  std::vector<std::string> found;
  std::string all;
  for (const std::string& channel : log.channels()) {
    if (channel == name) return channel;
    const bool ends =
        channel.size() > name.size() && channel.compare(channel.size() - name.size(), name.size(), name) == 0;
    if (ends && channel[channel.size() - name.size() - 1] == '/') found.push_back(channel);
    all += (all.empty() ? "" : ", ") + channel;
  }
  if (found.size() <= 1) return found.empty() ? "" : found.front();
  throw std::runtime_error(path + " has several channels " + name + " (it has: " + all +
                           "); make a log with `evit import`");
}

// The first message of a channel that `use` can use, from the beginning and from the end.
void ForFirstAndLast(LogReader* log, const std::string& channel,
                     const std::function<bool(const std::vector<std::uint8_t>&, bool first)>& use) {
  std::vector<std::uint8_t> bytes;
  const auto usable = [&](const LogEntry& entry, bool first) {
    if (channel.empty() || log->channel(entry) != channel) return false;
    log->Read(entry, &bytes);
    return use(bytes, first);
  };
  for (auto entry = log->entries().begin(); entry != log->entries().end() && !usable(*entry, true);) ++entry;
  for (auto entry = log->entries().rbegin(); entry != log->entries().rend() && !usable(*entry, false);)
    ++entry;
}

}  // namespace

RecordedData::RecordedData(const std::string& path)
    : log_(path), events_(FindChannel(log_, path, "EVENTS")), imu_(FindChannel(log_, path, "IMU")) {
  if (events_.empty() && imu_.empty())
    throw std::runtime_error(path + " has neither events nor an IMU; make a log with `evit import`");
  ForFirstAndLast(&log_, events_, [this](const std::vector<std::uint8_t>& bytes, bool first) {
    event_packet_t packet;
    EventArray events;
    if (DecodeChecked(bytes.data(), bytes.size(), &packet)) AppendEvents(packet, &events);
    if (events.size() == 0) return false;
    (first ? begin_ : end_) = first ? events.t.front() : events.t.back();
    return true;
  });
  ForFirstAndLast(&log_, imu_, [this](const std::vector<std::uint8_t>& bytes, bool first) {
    imu_batch_t batch;
    if (!DecodeChecked(bytes.data(), bytes.size(), &batch) || batch.n == 0) return false;
    (first ? imu_begin_ : imu_end_) = first ? SamplesOf(batch).front().t : SamplesOf(batch).back().t;
    return true;
  });
}

void RecordedData::Read(double seconds, const Sinks& sinks) {
  std::vector<std::uint8_t> bytes;
  event_packet_t packet;
  imu_batch_t batch;
  EventArray events;
  std::size_t done = 0;
  std::optional<Utime> first_events, first_imu;
  const std::vector<LogEntry>& entries = log_.entries();
  for (const LogEntry& entry : entries) {
    if (++done % 256 == 0) sinks.progress(static_cast<double>(done) / static_cast<double>(entries.size()));
    const std::string& channel = log_.channel(entry);
    if (channel != events_ && channel != imu_) continue;
    // Of each stream by itself: they may be on two clocks.
    std::optional<Utime>& first = channel == events_ ? first_events : first_imu;
    if (!first) first = entry.utime;
    if (ToSeconds(entry.utime - *first) > seconds) continue;
    log_.Read(entry, &bytes);
    if (channel == events_) {
      if (!DecodeChecked(bytes.data(), bytes.size(), &packet)) {
        ++malformed_;
        continue;
      }
      events.clear();
      AppendEvents(packet, &events);
      sinks.events(events);
    } else if (DecodeChecked(bytes.data(), bytes.size(), &batch)) {
      sinks.imu(SamplesOf(batch));
    } else {
      ++malformed_;
    }
  }
  sinks.progress(1);
}

}  // namespace evit::doctor
