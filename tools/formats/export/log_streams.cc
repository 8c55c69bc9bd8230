#include "tools/formats/export/log_streams.h"

#include <algorithm>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::formats {
namespace {

template <typename Message>
Message Decode(const std::string& path, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  Message message;
  std::string why;
  if (!DecodeChecked(bytes.data(), bytes.size(), &message, &why))
    throw std::runtime_error(path + ": a message on " + channel + " is damaged: " + why);
  return message;
}

}  // namespace

void ReadLogEvents(const std::string& path,
                   const std::function<void(const EventArray&, double share)>& take) {
  const LogReader log(path);
  const std::string channel = Channels().events;
  std::vector<std::uint8_t> bytes;
  EventArray events;
  std::size_t n = 0;
  for (const LogEntry& entry : log.entries()) {
    ++n;
    if (log.channel(entry) != channel) continue;
    log.Read(entry, &bytes);
    events.clear();
    AppendEvents(Decode<event_packet_t>(path, channel, bytes), &events);
    if (events.size() > 0) take(events, static_cast<double>(n) / static_cast<double>(log.entries().size()));
  }
}

LogStreams ScanLog(const std::string& path, bool allow_truncated) {
  LogStreams streams;
  const LogReader log(path);
  if (log.trailing_bytes() > 0 && !allow_truncated) {
    throw std::runtime_error(path + ": is truncated or damaged after " +
                             std::to_string(log.entries().size()) +
                             " complete messages; make it again, or export the complete ones with "
                             "--allow-truncated");
  }
  const Channels channels;
  std::vector<std::uint8_t> bytes;
  for (const LogEntry& entry : log.entries()) {
    const std::string& channel = log.channel(entry);
    if (channel != channels.imu && channel != channels.ground_truth) continue;
    log.Read(entry, &bytes);
    if (channel == channels.imu) {
      for (const ImuSample& s : SamplesOf(Decode<imu_batch_t>(path, channel, bytes)))
        streams.imu.push_back(s);
    } else {
      const auto m = Decode<body_pose_t>(path, channel, bytes);
      streams.truth.push_back({m.utime, {Eigen::Quaterniond(m.orientation), Eigen::Vector3d(m.position)}});
    }
  }
  ReadLogEvents(path, [&](const EventArray& events, double) {
    if (streams.n_events == 0) streams.first_event = events.t.front();
    streams.n_events += static_cast<std::int64_t>(events.size());
    streams.width = std::max(streams.width, 1 + *std::max_element(events.x.begin(), events.x.end()));
    streams.height = std::max(streams.height, 1 + *std::max_element(events.y.begin(), events.y.end()));
  });
  if (streams.n_events == 0) throw std::runtime_error(path + ": has no events on " + channels.events);
  return streams;
}

}  // namespace evit::formats
