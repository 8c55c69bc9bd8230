#pragma once

#include <memory>
#include <string>

#include "tools/feed/feed_input.h"

namespace evit::feed {

/// A recording (log of `evit import`) as a driver would send it: the same records, in order of time;
/// `realtime`: as fast as it was recorded, else as fast as they are taken. Throws std::runtime_error as
/// LogReader does, or where it has no events.
std::unique_ptr<FeedInput> OpenFakeCamera(const std::string& log, bool realtime);

}  // namespace evit::feed
