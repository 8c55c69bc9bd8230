#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>

namespace evit::terminal {

/// Progress of long work on stderr: a bar on a terminal; elsewhere a line at once, one every three seconds
/// and one at the end.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label)
      : label_(std::move(label)), tty_(isatty(STDERR_FILENO) == 1), begin_(Clock::now()) {}
  ~ProgressBar() {
    if (tty_ && drawn_) std::fputc('\n', stderr);
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `share`: 0..1. `note`: a few words shown behind it.
  void Show(double share, const std::string& note = "") {
    share = std::clamp(share, 0.0, 1.0);
    const auto now = Clock::now();
    const int percent = static_cast<int>(100 * share);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    char eta[24] = "";
    if (share > 0.02 && share < 1)
      std::snprintf(eta, sizeof eta, "%.0f s left", elapsed * (1 - share) / share);
    if (!tty_) {
      const bool ends = percent == 100 && last_ < 100;
      if (drawn_ && !ends && now - shown_ < kLinePeriod) return;
      std::fprintf(stderr, "%s: %d %% %s %s\n", label_.c_str(), percent, eta, note.c_str());
    } else {
      if (drawn_ && percent < 100 && now - shown_ < std::chrono::milliseconds(100)) return;
      constexpr int kWidth = 30;
      const int filled = static_cast<int>(kWidth * share);
      std::fprintf(stderr, "\r\033[K%s [%s%s] %3d %% %s %s", label_.c_str(), std::string(filled, '#').c_str(),
                   std::string(kWidth - filled, '.').c_str(), percent, eta, note.c_str());
    }
    std::fflush(stderr);
    drawn_ = true;
    shown_ = now;
    last_ = percent;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto kLinePeriod = std::chrono::seconds(3);
  std::string label_;
  bool tty_, drawn_ = false;
  Clock::time_point begin_, shown_;
  int last_ = 0;
};

}  // namespace evit::terminal
