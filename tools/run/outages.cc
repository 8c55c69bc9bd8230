#include "tools/run/outages.h"

#include <algorithm>

#include "common/bus/codec.h"

namespace evit {

Outages::Outages(Bus* bus, const Channels& channels) {
  bus->Subscribe(channels.window_state, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
    window_state_t message;
    if (DecodeChecked(data, size, &message) && message.mode == tracker_mode_t::TRACKING) Add(Clock::now());
  });
}

double Outages::MsAfter(Clock::time_point since, Clock::time_point until) const {
  const Clock::time_point end = std::min(until, since + std::chrono::seconds(2));
  auto next = std::upper_bound(arrivals_.begin(), arrivals_.end(), since);
  Clock::time_point before = next == arrivals_.begin() ? since : *(next - 1);
  Clock::duration longest{};
  Clock::time_point back = since;
  for (; before < end; ++next) {
    const Clock::time_point here = next == arrivals_.end() ? end : std::min(*next, end);
    if (here - before > longest) {
      longest = here - before;
      back = here;
    }
    before = here;
  }
  return std::chrono::duration<double, std::milli>(back - since).count();
}

}  // namespace evit
