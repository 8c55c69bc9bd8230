#include "tools/locate/recorded_streams.h"

#include <algorithm>
#include <stdexcept>

#include "common/bus/codec.h"
#include "common/text/words.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::locate {
RecordedStreams::RecordedStreams(const std::string& path) : log_(path) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t k = 0; k < log_.entries().size(); ++k) {
    const LogEntry& entry = log_.entries()[k];
    const std::string& channel = log_.channel(entry);
    const bool events = EndsWith(channel, "EVENTS");
    if (!events && !EndsWith(channel, "IMU")) continue;
    log_.Read(entry, &bytes);
    event_packet_t packet;
    imu_batch_t batch;
    if (events && DecodeChecked(bytes.data(), bytes.size(), &packet)) {
      packets_.emplace_back(packet.utime, k);
    } else if (!events && DecodeChecked(bytes.data(), bytes.size(), &batch)) {
      for (const ImuSample& sample : SamplesOf(batch))
        if (imu_.empty() || sample.t > imu_.back().t) imu_.push_back(sample);
    }
  }
  if (packets_.empty() || imu_.empty()) {
    throw std::runtime_error(path + ": holds no " + (imu_.empty() ? "IMU" : "EVENTS") +
                             " messages; make it with `evit import`, or record both channels");
  }
  std::stable_sort(packets_.begin(), packets_.end());
  begin_ = std::max(packets_.front().first, imu_.front().t);
  end_ = std::min(packets_.back().first, imu_.back().t);
}

EventArray RecordedStreams::Events(Utime begin, Utime end) const {
  EventArray events;
  std::vector<std::uint8_t> bytes;
  for (auto it = std::lower_bound(packets_.begin(), packets_.end(), std::make_pair(begin, std::size_t{0}));
       it != packets_.end() && it->first < end; ++it) {
    log_.Read(log_.entries()[it->second], &bytes);
    event_packet_t packet;
    if (DecodeChecked(bytes.data(), bytes.size(), &packet)) AppendEvents(packet, &events);
  }
  return events;
}

}  // namespace evit::locate
