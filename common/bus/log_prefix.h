#pragma once

#include <string>
#include <vector>

namespace evit {

/// The prefix of the pipeline's channels in a log that has the channels `names`: `requested`, where that is
/// not empty; else none where there is an EVENTS, else that of the only pair NAME/EVENTS and NAME/IMU.
/// Channels are never chosen by how they end alone: XSENS_IMU beside IMU is another sensor. Throws
/// std::runtime_error that names `path`, the channels and --log-prefix where no or several prefixes are
/// possible.
std::string FindLogPrefix(const std::string& path, const std::vector<std::string>& names,
                          const std::string& requested);

}  // namespace evit
