#include "tools/run/outages.h"

#include <algorithm>

#include "common/bus/codec.h"
#include "common/time/milliseconds.h"

namespace evit::run {
namespace {

// What dies is missed at once, but for what was under way: later gaps have other causes.
constexpr auto kInFlight = std::chrono::milliseconds(100);

}  // namespace

Outages::Outages(Bus* bus, const Channels& channels) {
  bus->Subscribe(channels.window_state,
                 [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                   window_state_t message;
                   if (DecodeChecked(data, size, &message) && message.mode == tracker_mode_t::TRACKING)
                     Add(Clock::now());
                 });
  bus->Subscribe(channels.tracker_mode,
                 [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                   tracker_mode_t message;
                   if (DecodeChecked(data, size, &message)) {
                     AddAnswer(Clock::now(), message.keyframe_epoch, message.keyframe_seq);
                   }
                 });
}

void Outages::AddAnswer(Clock::time_point at, std::int64_t epoch, std::int64_t seq) {
  if (epoch == epoch_ && seq > seq_ + 1 && seq_ >= 0) holes_.push_back({at, seq - seq_ - 1});
  if (epoch != epoch_ || seq > seq_) seq_ = seq;
  epoch_ = epoch;
}

std::int64_t Outages::KeyframesLostAfter(Clock::time_point since, Clock::time_point until) const {
  std::int64_t lost = 0;
  for (const Hole& hole : holes_) {
    if (hole.at > since && hole.at <= std::min(until, since + std::chrono::seconds(2)))
      lost += hole.keyframes;
  }
  return lost;
}

double Outages::MsAfter(Clock::time_point since, Clock::time_point until) const {
  const Clock::time_point end = std::min(until, since + std::chrono::seconds(2));
  auto next = std::upper_bound(arrivals_.begin(), arrivals_.end(), since);
  Clock::time_point before = next == arrivals_.begin() ? since : *(next - 1);
  Clock::duration longest{};
  Clock::time_point back = since;
  for (; before < std::min(end, since + kInFlight); ++next) {
    const Clock::time_point here = next == arrivals_.end() ? end : std::min(*next, end);
    if (here - before > longest) {
      longest = here - before;
      back = here;
    }
    before = here;
  }
  return Milliseconds(back - since);
}

}  // namespace evit::run
