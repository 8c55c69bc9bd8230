#include "tools/run/extrinsics_check.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/map/map_index.h"
#include "common/overlap/extrinsics_plausibility.h"
#include "common/wire/event_wire.h"

namespace evit::run {
namespace {

constexpr Utime kLook = 500'000;             // us of events
constexpr Utime kStill = 60'000;             // us for which the start pose stands, where there is no truth
constexpr std::size_t kMaxPoints = 200'000;  // more cost time and tell nothing more

EventArray FirstEvents(const RunJob& job, const LogSpan& span, Utime offset) {
  const LogReader log(job.log);
  const std::string channel = Channels(span.prefix).events;
  EventArray events;
  std::vector<std::uint8_t> bytes;
  event_packet_t message;
  for (const LogEntry& entry : log.entries()) {
    if (log.channel(entry) != channel) continue;
    log.Read(entry, &bytes);
    if (!DecodeChecked(bytes.data(), bytes.size(), &message)) continue;
    const Utime t = message.utime + offset;
    if (t > span.begin + kLook) break;
    if (t < span.begin - kStill) continue;
    AppendEvents(message, &events);
  }
  return events;
}

PointMap Thinned(const PointMap& map) {
  const std::size_t stride = 1 + map.points.size() / kMaxPoints;
  PointMap out;
  for (std::size_t k = 0; k < map.points.size(); k += stride) out.points.push_back(map.points[k]);
  return out;
}

}  // namespace

void CheckExtrinsics(const RunJob& job, const RunInputs& inputs, const LogSpan& span, const PointMap& map) {
  const Rig rig = LoadRig(job.rig);
  Trajectory body;
  for (const StampedPose& s : inputs.truth) {
    if (s.t <= span.begin + kLook) body.push_back(s);
  }
  if (body.size() < 10) {
    if (!inputs.start) return;
    const SE3& start = *inputs.start;
    body = {{span.begin - kStill, start}, {span.begin, start}, {span.begin + kStill, start}};
  }
  EventArray events = FirstEvents(job, span, rig.camera_time_offset);
  if (!std::is_sorted(events.t.begin(), events.t.end()))
    return;  // frame_builder sorts them; here they say nothing
  const std::string complaint = ExtrinsicsComplaint(rig, MapIndex(Thinned(map)), body, events);
  if (!complaint.empty())
    throw std::runtime_error(job.rig + ": " + complaint + "; --any-rig runs it as it is");
}

}  // namespace evit::run
