#include "common/service/loss_watch.h"

#include <cmath>

namespace evit {

void LossWatch::Update(const std::map<std::string, std::int64_t>& counters) {
  text_.clear();
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
    text_ += (text_.empty() ? "" : ", ") + std::to_string(std::lround(percent)) + " % of " + channel;
  }
  if (!text_.empty())
    text_ += " get lost: is net.core.rmem_max below 4 MiB, the link too slow, or the host too busy?";
}

}  // namespace evit
