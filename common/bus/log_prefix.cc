#include "common/bus/log_prefix.h"

#include <algorithm>
#include <stdexcept>

#include "common/bus/channels.h"

namespace evit {
namespace {

std::string Join(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
  return result;
}

}  // namespace

std::string FindLogPrefix(const std::string& path, const std::vector<std::string>& names,
                          const std::string& requested) {
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::string events = Channels().events, imu = Channels().imu;
  if (has(requested + events)) return requested;
  std::vector<std::string> pairs, alone;
  for (const std::string& name : names) {
    if (name.size() <= events.size() || name.compare(name.size() - events.size(), events.size(), events) != 0)
      continue;
    const std::string prefix = name.substr(0, name.size() - events.size());
    (has(prefix + imu) ? pairs : alone).push_back(prefix);
  }
  if (requested.empty() && pairs.size() == 1) return pairs[0];
  if (requested.empty() && pairs.empty() && alone.size() == 1) return alone[0];
  throw std::runtime_error("log " + path + " has no channel " + requested + events +
                           " (it has: " + Join(names) + "); " +
                           (pairs.empty() && alone.empty()
                                ? "make a log with `evit import`, or record EVENTS and IMU"
                                : "choose one with --log-prefix: " + Join(pairs.empty() ? alone : pairs)));
}

}  // namespace evit
