#include "services/log_replay/recording.h"

#include <algorithm>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/log_prefix.h"

namespace evit {

Recording::Recording(const std::string& path, const std::string& prefix, bool allow_truncated)
    : path_(path), log_(path) {
  if (log_.trailing_bytes() > 0 && !allow_truncated) {
    throw std::runtime_error(
        "log " + path + " is cut off or damaged: " + std::to_string(log_.trailing_bytes()) +
        " bytes after its last whole message (" + std::to_string(log_.entries().size()) +
        " are whole); make it again, or replay the complete ones with --allow-truncated");
  }
  const Channels channels(FindLogPrefix(path, log_.channels(), prefix));
  std::vector<int> kind_of(log_.channels().size(), -1);
  for (std::size_t c = 0; c < kind_of.size(); ++c) {
    const std::string& name = log_.channels()[c];
    if (name == channels.events) kind_of[c] = kEvents;
    if (name == channels.imu) kind_of[c] = kImu;
    if (name == channels.ground_truth) kind_of[c] = kGroundTruth;
  }
  for (const LogEntry& entry : log_.entries()) {
    const int kind = kind_of[static_cast<std::size_t>(entry.channel)];
    if (kind >= 0) messages_.push_back({entry, static_cast<Kind>(kind)});
  }
}

std::size_t Recording::FirstAt(std::int64_t utime) const {
  const auto found = std::find_if(messages_.begin(), messages_.end(),
                                  [utime](const Message& m) { return m.entry.utime >= utime; });
  return static_cast<std::size_t>(found - messages_.begin());
}

}  // namespace evit
