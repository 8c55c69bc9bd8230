#include "tools/monitor/channel_watch.h"

namespace evit::monitor {

void ChannelWatch::CountValid(const std::string& channel, const std::string& sender, std::int64_t epoch,
                              std::int64_t seq) {
  Figures& figures = channels_[channel];
  ++figures.received;
  const auto [stream, is_new] = streams_.try_emplace(channel + "/" + sender, Stream{epoch, seq + 1});
  if (is_new) return;
  if (stream->second.epoch != epoch) {
    ++figures.restarts;
    stream->second = {epoch, seq + 1};
    return;
  }
  if (seq > stream->second.next) figures.lost += seq - stream->second.next;
  if (seq >= stream->second.next) stream->second.next = seq + 1;
}

void ChannelWatch::UpdateRates(Clock::time_point now) {
  const double seconds = std::chrono::duration<double>(now - updated_).count();
  for (auto& [name, figures] : channels_) {
    std::int64_t& before = counted_[name];
    figures.rate_hz =
        updated_ == Clock::time_point() ? 0 : static_cast<double>(figures.received - before) / seconds;
    before = figures.received;
  }
  updated_ = now;
}

}  // namespace evit::monitor
