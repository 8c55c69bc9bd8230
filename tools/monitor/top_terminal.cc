#include "tools/monitor/top_terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "common/bus/lcm_bus.h"
#include "common/service/runner.h"
#include "common/service/stop_signals.h"
#include "tools/monitor/top_screen.h"
#include "tools/run/local_network.h"
#include "tools/run/run_file.h"

namespace evit::monitor {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPeriod = std::chrono::milliseconds(250);
constexpr auto kRatePeriod = std::chrono::seconds(1);
constexpr auto kOneLook = std::chrono::milliseconds(2200);  // services speak once a second, rates need two

// The terminal's second screen while this lives, so that the first one stays as it was.
class SecondScreen {
 public:
  explicit SecondScreen(bool use) : use_(use) {
    if (use_) std::fputs("\x1b[?1049h\x1b[?25l", stdout);
  }
  ~SecondScreen() {
    if (!use_) return;
    std::fputs("\x1b[?25h\x1b[?1049l", stdout);
    std::fflush(stdout);
  }
  SecondScreen(const SecondScreen&) = delete;
  SecondScreen& operator=(const SecondScreen&) = delete;

 private:
  bool use_;
};

winsize ScreenSize() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) {
    size.ws_col = 120;
    size.ws_row = 40;
  }
  return size;
}

}  // namespace

void ShowTop(const TopOptions& options) {
  if (run::IsLocalBus(options.lcm_url)) run::JoinNetworkOf(run::ChooseRunning(options.pid));
  const auto bus = OpenLcmBus(ResolveLcmUrl(options.lcm_url));
  PipelineWatch watch(bus.get(), Channels(options.prefix));
  procman::Sheriff sheriff(bus.get());
  TopScreen screen(&watch, &sheriff, options.prefix);
  sheriff.Discover();
  const bool once = options.once || isatty(STDOUT_FILENO) == 0;
  const StopSignals signals;
  const SecondScreen second(!once);
  const auto begin = Clock::now();
  auto drawn = begin, rated = begin;
  watch.UpdateRates();
  while (!signals.received()) {
    bus->Poll(50);
    const auto now = Clock::now();
    if (now - rated >= kRatePeriod) {
      watch.UpdateRates();
      sheriff.Forget(std::chrono::seconds(4));
      rated = now;
    }
    if (once && now - begin >= kOneLook) break;
    if (once || now - drawn < kPeriod) continue;
    drawn = now;
    const winsize size = ScreenSize();
    std::printf("\x1b[H%s\x1b[J", screen.Draw(size.ws_col, size.ws_row - 1, true).c_str());
    std::fflush(stdout);
  }
  if (once) std::fputs(screen.Draw(ScreenSize().ws_col, 1000, false).c_str(), stdout);
}

}  // namespace evit::monitor
