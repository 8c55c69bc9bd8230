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
  const std::string senders = Senders(counters);
  if (!senders.empty()) text_ = senders + (text_.empty() ? "" : "; " + text_);
}

std::string LossWatch::Senders(const std::map<std::string, std::int64_t>& counters) {
  std::string two, none;
  for (const auto& [name, value] : counters) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || value < 3) continue;
    std::string* list = name.substr(dot) == ".two_senders"  ? &two
                        : name.substr(dot) == ".unnumbered" ? &none
                                                            : nullptr;
    if (list != nullptr) *list += (list->empty() ? "" : ", ") + name.substr(0, dot);
  }
  std::string text;
  if (!two.empty())
    text = "two senders on " + two +
           ": another pipeline or driver is on this bus; give one of them --prefix or a port of its own";
  if (!none.empty())
    text += (text.empty() ? "" : "; ") + none +
            " not numbered (seq stays 0): what gets lost of them cannot be seen";
  return text;
}

}  // namespace evit
