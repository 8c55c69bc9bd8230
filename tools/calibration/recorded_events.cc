#include "tools/calibration/recorded_events.h"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/wire/event_wire.h"

namespace evit::calibration {

void ForEachEventPacket(const std::string& path, Utime begin, Utime end,
                        const std::function<void(const EventArray&)>& take) {
  const LogReader log(path);
  std::vector<std::uint8_t> bytes;
  event_packet_t packet;
  EventArray events;
  const std::string suffix = "EVENTS";
  bool any = false;
  for (const LogEntry& entry : log.entries()) {
    const std::string& channel = log.channel(entry);
    if (channel.size() < suffix.size() ||
        channel.compare(channel.size() - suffix.size(), suffix.size(), suffix) != 0)
      continue;
    log.Read(entry, &bytes);
    if (!DecodeChecked(bytes.data(), bytes.size(), &packet)) continue;
    any = true;
    events.clear();
    AppendEvents(packet, &events);
    if (events.t.empty() || events.t.back() < begin || events.t.front() > end) continue;
    take(events);
  }
  if (!any) throw std::runtime_error(path + ": holds no EVENTS; make it by evit import, or record EVENTS");
}

}  // namespace evit::calibration
