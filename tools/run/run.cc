#include "tools/run/run.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/bus/lcm_bus.h"
#include "common/service/runner.h"
#include "common/service/stop_signals.h"
#include "tools/run/alone_on_bus.h"
#include "tools/run/bus_log.h"
#include "tools/run/latency_probe.h"
#include "tools/run/local_network.h"
#include "tools/run/memory_log.h"
#include "tools/run/outages.h"
#include "tools/run/pipeline.h"
#include "tools/run/player.h"
#include "tools/run/recorder.h"
#include "tools/run/remote.h"
#include "tools/run/run_file.h"
#include "tools/run/run_inputs.h"
#include "tools/run/run_results.h"
#include "tools/run/service_commands.h"

namespace evit::run {
int Run(const RunJob& job) {
  const RunInputs inputs = PrepareRun(job);

  // Before the bus, whose threads would keep the old network.
  const std::string url = ResolveLcmUrl(job.lcm_url);
  std::unique_ptr<RunFile> run_file;
  bool own_network = false;
  if (IsLocalBus(job.lcm_url)) {
    own_network = EnsureLocalMulticast(url);
    run_file = std::make_unique<RunFile>(job.out);
  }

  const auto bus = OpenLcmBus(url);
  if (!own_network) RequireAlone(bus.get(), "evit" + job.prefix);
  const Channels channels(job.prefix);
  Recorder recorder(bus.get(), channels);
  std::unique_ptr<BusLog> bus_log;
  if (!job.record.empty())
    bus_log = std::make_unique<BusLog>(bus.get(), job.record,
                                       std::vector<std::string>{channels.keyframe, channels.window_state});
  std::unique_ptr<LatencyProbe> latency;
  if (!job.play.lossless && job.play.speed == 1 && job.play.loops == 1)
    latency = std::make_unique<LatencyProbe>(bus.get(), channels);
  const auto begin = std::chrono::steady_clock::now();
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  Outages outages(bus.get(), channels);
  const StopSignals signals;  // LCM's own test of the network, until here, ends with the process at Ctrl-C
  Pipeline pipeline(bus.get(), "evit" + job.prefix, ServiceCommands(job, url, inputs), programs, job.out);
  RunOutcome outcome;
  outcome.begin = begin;
  Remote remote(bus.get(), channels);
  MemoryLog memory(&pipeline);
  Player player(job, inputs, {bus.get(), &remote, &recorder, &pipeline, &memory});
  outcome.ended = player.Play(signals);
  outcome.end = std::chrono::steady_clock::now();
  outcome.wall_s = std::chrono::duration<double>(outcome.end - begin).count();
  outcome.outages = &outages;
  outcome.latency = latency.get();
  pipeline.Stop();
  RemoveRestartFiles(job);
  while (bus->Poll(50) > 0) {  // each service's last STATUS
  }
  if (job.play.loops > 1) memory.Write(job.out);
  const int code = WriteResults(job, inputs, recorder, pipeline, outcome);
  try {
    if (bus_log != nullptr) bus_log->Close();
  } catch (const std::runtime_error& error) {  // a full disk costs the log, not the results
    std::fprintf(stderr, "evit run: error: %s\n", error.what());
    return code == 0 ? 1 : code;
  }
  return code;
}

}  // namespace evit::run
