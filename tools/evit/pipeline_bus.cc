#include "tools/evit/pipeline_bus.h"

#include <chrono>
#include <stdexcept>

#include "common/bus/lcm_bus.h"
#include "common/service/runner.h"
#include "procman/sheriff.h"
#include "tools/run/local_network.h"
#include "tools/run/run_file.h"

namespace evit::commands {
namespace {

// Two senders of one channel are two cameras to whoever hears them; a lossless run ends with an error.
void RequireNoReplay(const std::string& url) {
  constexpr auto kLongest = std::chrono::seconds(2);
  const auto bus = OpenLcmBus(url);
  procman::Sheriff sheriff(bus.get());
  for (const auto& [deputy, info] : sheriff.Look(kLongest)) {
    for (const auto& status : info.cmds) {
      if (status.cmd.command_id != "log_replay" || status.pid == 0) continue;
      throw std::runtime_error(
          "the pipeline that runs here plays a log (log_replay), and two senders would mix: wait for its "
          "end, stop it (`evit stop log_replay`), or name another bus with --lcm-url");
    }
  }
}

}  // namespace

std::unique_ptr<Bus> OpenBusOfPipeline(const std::string& lcm_url) {
  if (run::IsLocalBus(lcm_url)) {
    const auto running = run::FindRunning();
    if (!running) {
      throw std::runtime_error(
          "neither `evit run` nor `evit up` is running on this host; give --lcm-url to reach another one");
    }
    run::JoinNetworkOf(*running);
  }
  return OpenLcmBus(ResolveLcmUrl(lcm_url));
}

std::unique_ptr<Bus> OpenBusToFeed(const std::string& lcm_url, pid_t pid) {
  const std::string url = ResolveLcmUrl(lcm_url);
  if (run::IsLocalBus(lcm_url) && (pid != 0 || run::FindRunning())) {
    run::JoinNetworkOf(run::ChooseRunning(pid));
    RequireNoReplay(url);
  }
  return OpenLcmBus(url);
}

}  // namespace evit::commands
