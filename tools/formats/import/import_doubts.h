#pragma once

#include <string>
#include <vector>

#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// What makes a log of little use that could be written all the same, a sentence each for a warning, with the
/// numbers and the least that is useful: a handful of events or IMU samples, an IMU too slow, or one that
/// covers little of the events' time. Empty: nothing.
std::vector<std::string> DoubtsOf(const ImportSummary& summary);

}  // namespace evit::formats
