#include "tools/run/sensor_check.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/text/format_text.h"
#include "common/wire/event_wire.h"

namespace evit::run {
namespace {

constexpr std::size_t kPackets = 300;      // are decoded: some hundred thousand events
constexpr std::int64_t kMostOutside = 20;  // one in so many, as in imports

}  // namespace

void CheckSensor(const RunJob& job, const LogSpan& span, const Camera& camera) {
  const LogReader log(job.log);
  const std::string channel = Channels(span.prefix).events;
  std::vector<const LogEntry*> packets;
  for (const LogEntry& entry : log.entries()) {
    if (log.channel(entry) == channel) packets.push_back(&entry);
  }
  const std::size_t stride = 1 + packets.size() / kPackets;
  EventArray events;
  std::vector<std::uint8_t> bytes;
  event_packet_t message;
  for (std::size_t k = 0; k < packets.size(); k += stride) {
    log.Read(*packets[k], &bytes);
    if (!DecodeChecked(bytes.data(), bytes.size(), &message)) continue;
    if (message.utime >= span.begin && message.utime <= span.end) AppendEvents(message, &events);
  }
  std::int64_t outside = 0;
  int x = 0, y = 0;
  for (std::size_t k = 0; k < events.size(); ++k) {
    x = std::max<int>(x, events.x[k]);
    y = std::max<int>(y, events.y[k]);
    if (events.x[k] >= camera.width || events.y[k] >= camera.height) ++outside;
  }
  const auto n = static_cast<std::int64_t>(events.size());
  if (kMostOutside * outside <= n) return;
  throw std::runtime_error(FormatText(
      "%s: %.0f %% of the events lie outside the image of %s (width: %d, height: %d); their largest x is %d, "
      "their largest y %d: give the rig file of the camera and resolution that were recorded",
      job.log.c_str(), 100.0 * static_cast<double>(outside) / static_cast<double>(n), job.rig.c_str(),
      camera.width, camera.height, x, y));
}

}  // namespace evit::run
