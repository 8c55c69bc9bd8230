#pragma once

#include <functional>
#include <string>

#include "common/events/event.h"

namespace evit::calibration {

/// Hands on the events of a log, packet by packet, in the file's order: those of all channels whose name ends
/// in EVENTS and whose packets lie at least partly within [begin, end] (us, the events' clock). Packets that
/// do not decode are left out. Throws std::runtime_error where the log holds no events at all.
void ForEachEventPacket(const std::string& log, Utime begin, Utime end,
                        const std::function<void(const EventArray&)>& take);

}  // namespace evit::calibration
