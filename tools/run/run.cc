#include "tools/run/run.h"

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/lcm_bus.h"
#include "common/bus/log_file.h"
#include "common/config/config.h"
#include "common/evaluation/trajectory_error.h"
#include "common/map/map_file.h"
#include "common/service/runner.h"
#include "tools/progress.h"
#include "tools/run/child.h"
#include "tools/run/local_network.h"
#include "tools/run/plot.h"
#include "tools/run/recorder.h"
#include "tools/run/report_writer.h"

namespace evit {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

volatile sig_atomic_t interrupted = 0;
void OnSignal(int) { interrupted = 1; }

double Seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// First and last data time of the part of the log that will be played.
std::pair<Utime, Utime> SpanOf(const RunJob& job) {
  const LogReader log(job.log);
  const Utime first = log.entries().front().utime, last = log.entries().back().utime;
  if (!job.seconds) return {first, last};
  return {first + static_cast<Utime>(job.seconds->first * 1e6),
          std::min(last, first + static_cast<Utime>(job.seconds->second * 1e6))};
}

SE3 InitialPose(const RunJob& job, const Trajectory& truth, Utime begin) {
  if (job.initial_pose) return *job.initial_pose;
  // The truth may begin a little later than the log.
  SE3 pose;
  for (Utime t = begin; t < begin + kMicrosPerSecond / 2; t += 1000) {
    if (PoseAt(truth, t, &pose)) return pose;
  }
  throw std::runtime_error(job.truth + ": has no pose at the start of the log (" + std::to_string(begin) +
                           " us): are both of the same sequence?");
}

std::string PoseText(const SE3& pose) {
  const std::string line = TumLine({0, pose});
  return line.substr(line.find(' ') + 1);
}

// Everything that can be wrong with the input is found before anything is started or written.
void CheckInputs(const RunJob& job) {
  LoadRig(job.rig);
  LoadTracker(job.config);
  RequireMetres(Summarize(LoadMap(job.map).map), job.map);
  std::error_code error;
  fs::create_directories(job.out, error);
  if (error || access(job.out.c_str(), W_OK) != 0) {
    throw std::runtime_error(job.out + ": is no folder that can be written");
  }
}

class Pipeline {
 public:
  Pipeline(const RunJob& job, const std::string& url, const SE3& start) {
    const fs::path programs = fs::read_symlink("/proc/self/exe").parent_path();
    const auto start_service = [&](const std::string& name, std::vector<std::string> arguments) {
      arguments.insert(arguments.end(), {"--lcm-url", url});
      if (!job.prefix.empty()) arguments.insert(arguments.end(), {"--prefix", job.prefix});
      if (job.lossless && name != "map_server") arguments.emplace_back("--lossless");
      const std::string log = job.out + "/" + name + ".log";
      fs::remove(log);
      children_.push_back(std::make_unique<Child>(name, (programs / name).string(), arguments, log));
    };
    start_service("map_server", {"--map", job.map});
    start_service("window_optimizer",
                  {"--rig", job.rig, "--config", job.config, "--initial-pose", PoseText(start)});
    start_service("frame_builder", {"--rig", job.rig, "--config", job.config});
    std::vector<std::string> replay{"--log", job.log};
    if (job.seconds) {
      replay.insert(replay.end(), {"--seconds", std::to_string(job.seconds->first) + ":" +
                                                    std::to_string(job.seconds->second)});
    }
    if (!job.lossless) replay.insert(replay.end(), {"--speed", std::to_string(job.speed), "--start-paused"});
    start_service("log_replay", replay);
  }

  /// Throws where a service has died that cannot be replaced; a dead map_server is started again: it has no
  /// state.
  void Watch() {
    for (const auto& child : children_) {
      if (child->Running()) continue;
      if (child->name() == "map_server" && restarts_ < 20) {
        ++restarts_;
        child->Start();
        continue;
      }
      throw std::runtime_error(child->name() + " died with " + child->end() + child->LastWords());
    }
  }

  /// Replay first, so that nobody waits for what is gone.
  void Stop() {
    for (auto child = children_.rbegin(); child != children_.rend(); ++child) (*child)->Stop();
  }

  int restarts() const { return restarts_; }
  const std::vector<std::unique_ptr<Child>>& children() const { return children_; }

 private:
  std::vector<std::unique_ptr<Child>> children_;
  int restarts_ = 0;
};

void SendResume(Bus* bus, const Channels& channels) {
  replay_control_t order{};
  order.command = replay_control_t::RESUME;
  std::vector<std::uint8_t> bytes;
  EncodeTo(order, &bytes);
  bus->Publish(channels.replay_control, bytes.data(), bytes.size());
}

bool AllThere(const Recorder& recorder) {
  for (const char* name : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
    if (recorder.statuses().count(name) == 0) return false;
  }
  return true;
}

// Until the run is over; says how it ended.
std::string WaitForEnd(const RunJob& job, Bus* bus, const Channels& channels, Recorder* recorder,
                       Pipeline* pipeline) {
  ProgressBar bar("tracking");
  bool resumed = job.lossless;
  auto last_activity = Clock::now();
  while (interrupted == 0) {
    bus->Poll(20);
    pipeline->Watch();
    if (!resumed && AllThere(*recorder)) {
      SendResume(bus, channels);
      resumed = true;
    }
    static constexpr const char* kModes[] = {"bootstrapping", "tracking", "LOST"};
    bar.Show(recorder->progress(), recorder->n_keyframes() == 0
                                       ? "starting"
                                       : std::to_string(recorder->n_keyframes()) + " keyframes, " +
                                             kModes[recorder->mode().mode % 3]);
    if (recorder->Finished()) return "finished";
    if (recorder->TakeActivity()) last_activity = Clock::now();
    const double silence = Seconds(Clock::now() - last_activity);
    if (!job.lossless && recorder->progress() >= 1 && silence > 5) return "finished";
    if (silence > 60) {
      std::string what;
      for (const auto& [name, status] : recorder->statuses())
        what += "\n  " + name + ": " + status.state + ": " + status.detail;
      throw std::runtime_error("nothing has moved for 60 s; the services say:" + what);
    }
  }
  return "interrupted";
}

}  // namespace

int Run(const RunJob& job) {
  CheckInputs(job);
  Trajectory truth;
  if (!job.truth.empty()) truth = ReadTum(job.truth);
  const auto [begin, end] = SpanOf(job);
  const SE3 start = InitialPose(job, truth, begin);

  std::unique_ptr<RunFile> run_file;
  const std::string url = ResolveLcmUrl(job.lcm_url);
  if (job.lcm_url.empty() && std::getenv("LCM_DEFAULT_URL") == nullptr && EnsureLocalMulticast(url)) {
    run_file = std::make_unique<RunFile>();
  }
  struct sigaction action {};
  action.sa_handler = OnSignal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);

  const auto bus = OpenLcmBus(url);
  const Channels channels(job.prefix);
  Recorder recorder(bus.get(), channels);
  const auto wall_begin = Clock::now();
  Pipeline pipeline(job, url, start);
  report::Report report;
  report.set_ended(WaitForEnd(job, bus.get(), channels, &recorder, &pipeline));
  const double wall = Seconds(Clock::now() - wall_begin);
  pipeline.Stop();
  while (bus->Poll(50) > 0) {
  }  // each service's last STATUS

  // --- results
  const Trajectory &online = recorder.online(), smoothed = recorder.smoothed();
  WriteTum(job.out + "/trajectory.tum", online);
  WriteTum(job.out + "/smoothed.tum", smoothed);
  char host[128] = "";
  gethostname(host, sizeof host - 1);
  report.set_command(job.command);
  report.set_host(host);
  report.set_rig(job.rig);
  report.set_map(job.map);
  report.set_log(job.log);
  report.set_config(ReadText(job.config));
  report.set_lossless(job.lossless);
  double cpu = 0;
  for (const auto& child : pipeline.children()) {
    report::Service* service = report.add_services();
    service->set_name(child->name());
    service->set_cpu_s(child->cpu_seconds());
    service->set_peak_memory_mb(child->peak_mb());
    cpu += child->cpu_seconds();
  }
  FillFromRecorder(recorder, &report);
  const double sequence = ToSeconds(end - begin);
  report.set_sequence_s(sequence);
  report.set_wall_s(wall);
  report.set_real_time_factor(sequence / wall);
  report.set_keyframe_rate_hz(static_cast<double>(report.keyframes()) / sequence);
  if (report.keyframes() > 0)
    report.set_cpu_ms_per_keyframe(1e3 * cpu / static_cast<double>(report.keyframes()));
  const auto builder = recorder.statuses().find("frame_builder");
  if (builder != recorder.statuses().end()) {
    report.set_events(CounterOf(builder->second, "events"));
    report.set_event_rate_per_s(static_cast<double>(report.events()) / sequence);
  }
  std::string title = fs::path(job.log).filename().string();
  Trajectory part;
  for (const StampedPose& s : truth) {
    if (s.t >= begin && s.t <= end) part.push_back(s);
  }
  if (!part.empty() && !online.empty()) {
    FillErrors(part, online, &report);
    const report::Error& all = report.ate(0).all();
    char text[160];
    std::snprintf(text, sizeof text,
                  ": ATE %.2f cm, %.2f deg (map frame, no alignment), %.0f %% of the sequence",
                  all.position_rmse_cm(), all.orientation_rmse_deg(), 100 * report.coverage());
    title += text;
  }
  WriteReport(job.out + "/report.json", report);
  PlotRun(job.out + "/trajectory.png", title, part, online);

  std::printf(
      "%s\n%lld keyframes (%.0f Hz), %.1f s in %.1f s: real-time factor %.2f; %.1f ms CPU per keyframe; "
      "map_server "
      "restarts: %d\n",
      title.c_str(), static_cast<long long>(report.keyframes()), report.keyframe_rate_hz(), sequence, wall,
      report.real_time_factor(), report.cpu_ms_per_keyframe(), pipeline.restarts());
  std::printf("results: %s/{trajectory.tum,smoothed.tum,report.json,trajectory.png}\n", job.out.c_str());
  if (report.final_mode() != "TRACKING") {
    std::fprintf(stderr, "evit run: %s at the end: %s\n", report.final_mode().c_str(),
                 recorder.mode().reason.c_str());
    return 2;
  }
  return report.ended() == "interrupted" ? 130 : 0;
}

}  // namespace evit
