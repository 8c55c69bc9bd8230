// What log_replay says of itself.
#include <cmath>
#include <cstdio>

#include "common/service/credit_sender.h"
#include "services/log_replay/log_replay.h"

namespace evit {

namespace {

constexpr std::int64_t kSilenceUs = 3'000'000;  // consumers send credit every 50 ms

std::string Join(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
  return result;
}

}  // namespace

bool LogReplay::done() const {
  return options_.exit_at_end && phase_ == Phase::kEnded && announcer_.Settled(SteadyTime());
}

void LogReplay::Report(std::int64_t now_us) {
  reported_us_ = now_us;
  const double length = 1e-6 * static_cast<double>(recording_.utime(end_ - 1) - recording_.utime(begin_));
  const double position = 1e-6 * static_cast<double>(DataTime() - recording_.utime(begin_));
  status_.SetProgress(next_ == end_ ? 1.0 : (length > 0 ? position / length : 0.0));
  status_.Counter("speed_percent") = std::llround(100 * pacer_.speed());  // of real time; 0: unpaced
  char place[96];
  std::snprintf(place, sizeof(place), "%.2f of %.2f s", position, length);
  const std::string where = options_.log + ": " + place;
  const bool silent =
      options_.lossless && !everything_delivered() && window_.longest_silence(now_us) > kSilenceUs;
  if (phase_ == Phase::kWaiting && options_.lossless) {
    status_.SetState("waiting", "for CREDIT from " + Join(window_.missing_consumers()) +
                                    ": is it running with --lossless?");
  } else if (paused_) {
    status_.SetState("paused", where);
  } else if (silent) {
    status_.SetState("waiting", where + "; no CREDIT for " +
                                    std::to_string(window_.longest_silence(now_us) / 1'000'000) +
                                    " s: has a consumer (" + Join(options_.wait_for) + ") died?");
  } else if (phase_ == Phase::kEnded) {
    status_.SetState(everything_delivered() ? "finished" : "running", where + ", all sent");
  } else {
    status_.SetState("running", where);
  }
}

void LogReplay::Stop() {
  // Played to its end, it starts over next time; stopped or killed before, it continues.
  if (position_ && phase_ == Phase::kEnded) position_->Clear();
  status_.SetState("finished", options_.log + ": stopped");
  status_.Publish();
}

}  // namespace evit
