#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace evit::monitor {

/// What a listener counts of each channel: received, lost (jumps of seq), invalid, rate.
class ChannelWatch {
 public:
  using Clock = std::chrono::steady_clock;
  struct Figures {
    std::int64_t received = 0, lost = 0, invalid = 0, restarts = 0;
    double rate_hz = 0;  // of the last second or two
  };

  /// `sender`: several may share a channel, each with its own epoch and seq (STATUS); else empty.
  void CountValid(const std::string& channel, const std::string& sender, std::int64_t epoch,
                  std::int64_t seq);
  void CountInvalid(const std::string& channel) { ++channels_[channel].invalid; }

  /// Brings the rates up to date; call about once a second.
  void UpdateRates(Clock::time_point now);
  const std::map<std::string, Figures>& channels() const { return channels_; }

 private:
  struct Stream {
    std::int64_t epoch, next;
  };
  std::map<std::string, Figures> channels_;
  std::map<std::string, Stream> streams_;        // by channel and sender
  std::map<std::string, std::int64_t> counted_;  // received at the last UpdateRates
  Clock::time_point updated_;
};

}  // namespace evit::monitor
