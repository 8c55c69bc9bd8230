#include "tools/monitor/monitor_process.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/bus/lcm_bus.h"
#include "common/geometry/pose_text.h"
#include "common/service/runner.h"
#include "common/service/stop_signals.h"
#include "tools/monitor/local_files.h"
#include "tools/run/local_network.h"
#include "tools/run/run_file.h"

namespace evit::monitor {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kNextPipeline = 75;  // a worker's exit code: another one shall show the new pipeline
constexpr int kPollMs = 10;
constexpr auto kLookPeriod = std::chrono::milliseconds(300);
constexpr auto kFilesPeriod = std::chrono::seconds(1);
constexpr auto kPause = std::chrono::milliseconds(500);  // before a worker that has died is replaced

// Looks now and then whether another pipeline runs.
class PipelineFinder {
 public:
  explicit PipelineFinder(pid_t only) : only_(only) {}

  /// The newest one that can be watched; nothing between two looks.
  std::optional<run::RunningPipeline> Look() {
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < kLookPeriod) return std::nullopt;
    looked_ = now;
    for (const run::RunningPipeline& found : run::FindAllRunning()) {
      if ((only_ == 0 || found.pid == only_) && IsOurs(found)) return found;
    }
    return std::nullopt;
  }

 private:
  bool IsOurs(const run::RunningPipeline& found) {
    const auto [at, is_new] = ours_.try_emplace(found.pid, false);
    if (!is_new) return at->second;
    at->second = run::CanJoinNetworkOf(found);
    if (!at->second)
      std::fprintf(
          stderr,
          "evit monitor: the pipeline of process %d belongs to somebody else, or runs in a container: "
          "not shown\n",
          static_cast<int>(found.pid));
    return at->second;
  }

  pid_t only_;
  std::map<pid_t, bool> ours_;
  std::chrono::steady_clock::time_point looked_;
};

// What the pipeline's services were given and the user did not name. They start one after the other, so that
// this is tried again until all is known.
void ShowLocalFiles(const LocalFiles& found, LocalFiles* known, Monitor* monitor) {
  LocalFiles fresh;
  if (known->map.empty()) fresh.map = known->map = found.map;
  if (known->rig.empty()) fresh.rig = known->rig = found.rig;
  try {
    monitor->ShowFiles(fresh.map, fresh.rig);
    if (!known->start && found.start) {
      known->start = found.start;
      if (!found.start->empty()) monitor->SetStart(ParsePose("--initial-pose", *found.start));
    }
  } catch (const std::exception& error) {
    // The services have said so as well; the map and the camera are then learnt from the bus.
    std::fprintf(stderr, "evit monitor: %s\n", error.what());
  }
}

}  // namespace

MonitorProcess::MonitorProcess(MonitorOptions options, std::string lcm_url)
    : options_(std::move(options)), lcm_url_(std::move(lcm_url)) {}

int MonitorProcess::WatchBus() {
  const StopSignals signals;
  Monitor monitor(options_);
  const std::string url = ResolveLcmUrl(lcm_url_);
  const auto bus = OpenLcmBus(url);
  monitor.Watch(bus.get());
  LocalFiles files{options_.map, options_.rig, std::nullopt};
  Clock::time_point looked;
  while (!signals.received()) {
    // The pipeline may run here, whatever its bus.
    if (const auto now = Clock::now(); !files.complete() && now - looked >= kFilesPeriod) {
      looked = now;
      ShowLocalFiles(FindLocalFiles(url, options_.prefix), &files, &monitor);
    }
    bus->Poll(monitor.busy() ? 0 : kPollMs);
    monitor.Tick();
  }
  return 0;
}

int MonitorProcess::WatchLocal() {
  const StopSignals signals;
  Monitor monitor(options_);
  monitor.SetWaiting("waiting for `evit run` or `evit up` on this host");
  PipelineFinder finder(options_.pipeline);
  std::optional<run::RunningPipeline> shown;
  std::unique_ptr<Bus> bus;
  LocalFiles files{options_.map, options_.rig, std::nullopt};
  while (!signals.received()) {
    const auto found = finder.Look();
    if (found && !shown) {
      // Before the bus, whose threads would keep the old network.
      run::JoinNetworkOf(*found);
      bus = OpenLcmBus(ResolveLcmUrl(lcm_url_));
      monitor.Watch(bus.get());
      shown = found;
    } else if (found && found->pid != shown->pid) {
      return kNextPipeline;
    }
    if (found && !files.complete()) ShowLocalFiles(FindLocalFiles(found->pid), &files, &monitor);
    if (bus) {
      bus->Poll(monitor.busy() ? 0 : kPollMs);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(kPollMs));
    }
    monitor.Tick();
  }
  return 0;
}

int MonitorProcess::Work(bool first) {
  const pid_t parent = getpid();
  const pid_t worker = fork();
  if (worker < 0) throw std::runtime_error("cannot start a process");
  if (worker == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(0);
    int code = 1;
    try {
      code = run::IsLocalBus(lcm_url_) ? WatchLocal() : WatchBus();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "evit monitor: error: %s\n", error.what());
      code = first ? 2 : 1;
    }
    _exit(code);
  }
  const StopSignals signals;
  int status = 0;
  while (waitpid(worker, &status, WNOHANG) == 0) {
    if (signals.received()) {
      kill(worker, SIGTERM);
      waitpid(worker, &status, 0);
      return 0;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

int MonitorProcess::Run() {
  bool first = true;
  for (;;) {
    const int code = Work(first);
    if (code == 0) return 0;
    if (code == 2) return 1;
    if (code != kNextPipeline) std::this_thread::sleep_for(kPause);
    first = false;
  }
}

}  // namespace evit::monitor
