#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace evit {

/// Notices from a service's counters which channels lose messages at the moment.
class LossWatch {
 public:
  /// Look at the counters, once a second or so. Returns a sentence for a person, empty where all is well:
  /// no channel has lost more than 1 % (and at least three messages) since the last look but one.
  std::string Look(const std::map<std::string, std::int64_t>& counters) {
    std::string text;
    for (const auto& [name, lost] : counters) {
      const std::size_t dot = name.rfind(".lost");
      if (dot == std::string::npos || dot + 5 != name.size()) continue;
      const std::string channel = name.substr(0, dot);
      const auto received = counters.find(channel + ".received");
      if (received == counters.end()) continue;
      Seen& seen = seen_[channel];
      const std::int64_t more_lost = lost - seen.before_last.lost;
      const std::int64_t more = more_lost + received->second - seen.before_last.received;
      seen.before_last = seen.last;
      seen.last = {lost, received->second};
      const double percent = 100.0 * static_cast<double>(more_lost) / static_cast<double>(more);
      if (more_lost < 3 || percent <= 1) continue;
      text += (text.empty() ? "" : ", ") + std::to_string(std::lround(percent)) + " % of " + channel;
    }
    if (text.empty()) return text;
    return text + " get lost: is net.core.rmem_max below 4 MiB, the link too slow, or the host too busy?";
  }

 private:
  struct Count {
    std::int64_t lost = 0, received = 0;
  };
  struct Seen {
    Count before_last, last;
  };
  std::map<std::string, Seen> seen_;
};

}  // namespace evit
