#include "tools/run/run.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

#include "common/bus/lcm_bus.h"
#include "common/evaluation/trajectory_error.h"
#include "common/service/runner.h"
#include "common/service/stop_signals.h"
#include "tools/run/bus_log.h"
#include "tools/run/latency.h"
#include "tools/run/local_network.h"
#include "tools/run/memory_log.h"
#include "tools/run/outages.h"
#include "tools/run/pipeline.h"
#include "tools/run/recorder.h"
#include "tools/run/remote.h"
#include "tools/run/run_inputs.h"
#include "tools/run/run_results.h"
#include "tools/terminal/progress_bar.h"

namespace evit::run {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRealTimeSilence = 5;  // s after the end of the log: nothing more is to come
constexpr double kStuck = 60;           // s without anything from the tracker
constexpr char kCheckpoint[] = "checkpoint", kPosition[] = "position";  // files for restarts within a run

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::string PoseText(const SE3& pose) {
  const std::string line = TumLine({0, pose});
  return line.substr(line.find(' ') + 1);
}

std::vector<procman::ProcmanCommand> Commands(const RunJob& job, const std::string& url, const SE3& start) {
  const auto state_file = [&](const char* name) {
    std::string path = job.out + "/" + name;
    std::filesystem::remove(path);  // of an earlier run
    return path;
  };
  std::vector<std::string> map_server{"map_server"};
  if (!job.map.empty()) map_server.insert(map_server.end(), {"--map", job.map});
  if (!job.photometric_map.empty())
    map_server.insert(map_server.end(), {"--photometric-map", job.photometric_map});
  std::vector<std::string> optimizer{"window_optimizer", "--rig", job.rig, "--initial-pose", PoseText(start)};
  std::vector<std::string> builder{"frame_builder", "--rig", job.rig};
  if (!job.config.empty()) {
    for (auto* words : {&optimizer, &builder}) words->insert(words->end(), {"--config", job.config});
  }
  std::vector<std::string> replay{"log_replay", "--log", job.log};
  if (job.seconds) {
    const auto [begin, end] = *job.seconds;
    replay.insert(replay.end(), {"--seconds", std::to_string(begin) + ":" + std::to_string(end)});
  }
  if (!job.lossless) {
    optimizer.insert(optimizer.end(), {"--checkpoint", state_file(kCheckpoint)});
    // In real time nobody waits: playing begins when all the others are there.
    replay.insert(replay.end(), {"--speed", std::to_string(job.speed), "--start-paused", "--position",
                                 state_file(kPosition)});
  }
  std::vector<procman::ProcmanCommand> commands;
  for (std::vector<std::string>* words : {&map_server, &optimizer, &builder, &replay}) {
    words->insert(words->end(), {"--lcm-url", url});
    if (!job.prefix.empty()) words->insert(words->end(), {"--prefix", job.prefix});
    if (job.lossless && words != &map_server) words->emplace_back("--lossless");
    procman::ProcmanCommand command;
    command.id = words->front();
    command.exec = procman::JoinCommandLine(*words);
    command.group = "evit";
    // Lossless replay counts every message, so a service that restarts in the middle cannot catch up; only
    // map_server keeps no count.
    command.auto_respawn = !job.lossless || words == &map_server;
    command.stop_time_allowed = 2;
    commands.push_back(std::move(command));
  }
  return commands;
}

/// Tells log_replay to begin once all services are there, and again until it obeys: UDP may lose an order.
class StartSignal {
 public:
  explicit StartSignal(Remote* remote) : remote_(remote) {}

  void Tick(const Recorder& recorder) {
    for (const char* name : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
      if (recorder.statuses().count(name) == 0) return;
    }
    if (recorder.statuses().at("log_replay").state != "paused") return;
    if (sent_ && SecondsSince(sent_at_) < 0.5) return;
    remote_->Resume();
    sent_ = true;
    sent_at_ = Clock::now();
  }

 private:
  Remote* remote_;
  bool sent_ = false;
  Clock::time_point sent_at_;
};

void Show(const Recorder& recorder, terminal::ProgressBar* bar) {
  static constexpr const char* kModes[] = {"bootstrapping", "tracking", "LOST"};
  const std::int64_t n = recorder.n_keyframes();
  bar->Show(recorder.progress(),
            n == 0 ? "starting" : std::to_string(n) + " keyframes, " + kModes[recorder.mode().mode % 3]);
}

[[noreturn]] void FailStuck(const Recorder& recorder, const std::string& what) {
  std::string text = what + "; status of the services:";
  for (const auto& [name, status] : recorder.statuses()) {
    text += "\n  " + name + ": " + status.state + ": " + status.detail;
  }
  throw std::runtime_error(text);
}

// Until the run is over; returns how it ended.
std::string WaitForEnd(const RunJob& job, const StopSignals& signals, Bus* bus, Remote* remote,
                       Recorder* recorder, Pipeline* pipeline, MemoryLog* memory) {
  terminal::ProgressBar bar("tracking");
  StartSignal start(remote);
  auto last_activity = Clock::now();
  while (!signals.received()) {
    bus->Poll(20);
    pipeline->Watch();
    memory->Tick();
    if (!job.lossless) start.Tick(*recorder);
    Show(*recorder, &bar);
    if (recorder->Finished()) return "finished";
    for (const auto& [name, status] : recorder->statuses()) {
      if (status.state == "failed") FailStuck(*recorder, name + " failed");
    }
    if (recorder->TakeActivity()) last_activity = Clock::now();
    const double silence = SecondsSince(last_activity);
    if (!job.lossless && recorder->progress() >= 1 && silence > kRealTimeSilence) return "finished";
    if (silence > kStuck) FailStuck(*recorder, "no message from the tracker for 60 s");
  }
  return "interrupted";
}

// Plays the log again, from the pose it starts with.
void PlayAgain(const SE3& start, Bus* bus, Remote* remote, Recorder* recorder) {
  remote->Rewind();
  recorder->StartOver();
  const auto begin = Clock::now();
  while (SecondsSince(begin) < 5 && (recorder->Finished() || recorder->progress() >= 1)) {
    remote->HintPose(start);
    bus->Poll(50);
    if (SecondsSince(begin) > 1 && recorder->progress() >= 1) remote->Rewind();  // the first order got lost
  }
  remote->HintPose(start);
}

// All loops of the log; returns how it ended.
std::string Play(const RunJob& job, const RunInputs& inputs, const StopSignals& signals, Bus* bus,
                 Remote* remote, Recorder* recorder, Pipeline* pipeline, MemoryLog* memory) {
  for (int loop = 1;; ++loop) {
    const std::string ended = WaitForEnd(job, signals, bus, remote, recorder, pipeline, memory);
    if (job.loops > 1) {
      const TrajectoryError error = AbsoluteError(inputs.truth, recorder->online(), Alignment::kNone);
      std::printf("loop %d: %zu poses, ATE %.2f cm, %s\n", loop, recorder->online().size(),
                  100 * error.position_rmse, recorder->mode().reason.c_str());
      std::fflush(stdout);
    }
    if (ended != "finished" || loop >= job.loops) return ended;
    PlayAgain(inputs.start, bus, remote, recorder);
  }
}

}  // namespace

int Run(const RunJob& job) {
  const RunInputs inputs = PrepareRun(job);

  // Before the bus, whose threads would keep the old network.
  const std::string url = ResolveLcmUrl(job.lcm_url);
  const char* asked = std::getenv("LCM_DEFAULT_URL");
  const bool own_choice = job.lcm_url.empty() && (asked == nullptr || *asked == '\0');
  std::unique_ptr<RunFile> run_file;
  if (own_choice) {
    EnsureLocalMulticast(url);
    run_file = std::make_unique<RunFile>(job.out);
  }

  const StopSignals signals;

  const auto bus = OpenLcmBus(url);
  const Channels channels(job.prefix);
  Recorder recorder(bus.get(), channels);
  std::unique_ptr<BusLog> bus_log;
  if (!job.record.empty())
    bus_log = std::make_unique<BusLog>(bus.get(), job.record,
                                       std::vector<std::string>{channels.keyframe, channels.window_state});
  std::unique_ptr<LatencyProbe> latency;
  if (!job.lossless && job.speed == 1 && job.loops == 1)
    latency = std::make_unique<LatencyProbe>(bus.get(), channels);
  const auto begin = Clock::now();
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  Outages outages(bus.get(), channels);
  Pipeline pipeline(bus.get(), "evit" + job.prefix, Commands(job, url, inputs.start), programs, job.out);
  RunOutcome outcome;
  outcome.begin = begin;
  Remote remote(bus.get(), channels);
  MemoryLog memory(&pipeline);
  outcome.ended = Play(job, inputs, signals, bus.get(), &remote, &recorder, &pipeline, &memory);
  outcome.end = Clock::now();
  outcome.wall_s = SecondsSince(begin);
  outcome.outages = &outages;
  outcome.latency = latency.get();
  pipeline.Stop();
  for (const char* name : {kCheckpoint, kPosition}) std::filesystem::remove(job.out + "/" + name);
  while (bus->Poll(50) > 0) {  // each service's last STATUS
  }
  if (job.loops > 1) memory.Write(job.out);
  if (bus_log != nullptr) bus_log->Close();
  return WriteResults(job, inputs, recorder, pipeline, outcome);
}

}  // namespace evit::run
