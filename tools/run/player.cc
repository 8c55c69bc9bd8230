#include "tools/run/player.h"

#include <cstdint>
#include <cstdio>
#include <stdexcept>

#include "common/evaluation/trajectory_error.h"
#include "procman/process_usage.h"
#include "tools/terminal/progress_bar.h"

namespace evit::run {

namespace {

constexpr double kRealTimeSilence = 5;  // s idle after the end of the log: nothing more is to come
constexpr double kUsagePeriod = 0.5;    // s

double SecondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

ServiceTime UsedBy(const Pipeline& pipeline) {
  ServiceTime used;
  for (const auto& process : pipeline.processes()) {
    if (!process->running()) continue;
    used.computing += procman::ReadProcessUsage(process->pid()).cpu_seconds;
    used.waiting += procman::ReadProcessorWait(process->pid());
  }
  return used;
}

void Show(const Recorder& recorder, terminal::ProgressBar* bar) {
  static constexpr const char* kModes[] = {"bootstrapping", "tracking", "LOST"};
  const std::int64_t n = recorder.n_keyframes();
  const char* doing = recorder.paused() ? "paused" : kModes[recorder.mode().mode % 3];
  bar->Show(recorder.progress(), n == 0 ? "starting" : std::to_string(n) + " keyframes, " + doing);
}

}  // namespace

Player::Player(const RunJob& job, const RunInputs& inputs, const Parts& parts)
    : job_(job), inputs_(inputs), parts_(parts) {}

std::string Player::Play(const StopSignals& signals) {
  StartSignal start(parts_.remote);
  for (int loop = 1;; ++loop) {
    std::string ended = WaitForEnd(signals, &start);
    if (job_.play.loops > 1) PrintLoop(loop);
    if (ended != "finished" || loop >= job_.play.loops) return ended;
    PlayAgain();
  }
}

std::string Player::WaitForEnd(const StopSignals& signals, StartSignal* start) {
  terminal::ProgressBar bar("tracking");
  StallWatch watch;
  const Clock::time_point begin = Clock::now();
  double looked = -kUsagePeriod;
  while (!signals.received()) {
    parts_.bus->Poll(20);
    parts_.pipeline->Watch();
    parts_.memory->Tick();
    if (!job_.play.lossless) start->Tick(*parts_.recorder);
    Show(*parts_.recorder, &bar);
    const bool held = parts_.recorder->paused() && (job_.play.lossless || start->begun());
    if (parts_.recorder->TakeActivity() || held) watch.Progress();
    if (const double now = SecondsSince(begin); now - looked >= kUsagePeriod) {
      looked = now;
      watch.Tick(now, UsedBy(*parts_.pipeline));
    }
    if (Over(watch)) return "finished";
    RequireHealthy(watch);
  }
  return "interrupted";
}

bool Player::Over(const StallWatch& watch) const {
  if (parts_.recorder->Finished()) return true;
  return !job_.play.lossless && parts_.recorder->progress() >= 1 && watch.idle() > kRealTimeSilence;
}

void Player::RequireHealthy(const StallWatch& watch) const {
  std::string problem;
  if (watch.stuck()) {
    problem = watch.idle() > StallWatch::kIdle
                  ? "no message from the tracker, and the services have had nothing to do for 60 s"
                  : "no message from the tracker in ten minutes of computing";
  }
  if (const std::string& service = parts_.recorder->two_senders(); !service.empty()) {
    throw std::runtime_error(
        "two services say that they are " + service +
        ": another pipeline is on this bus; give one of them --prefix NAME/ or another port in "
        "--lcm-url");
  }
  for (const auto& [name, status] : parts_.recorder->statuses()) {
    if (status.state == "failed") problem = name + " failed";
  }
  if (!problem.empty()) throw std::runtime_error(problem + "; " + StatusText(*parts_.recorder));
}

// Plays the log again, from the pose it starts with.
void Player::PlayAgain() {
  const Recorder& recorder = *parts_.recorder;
  parts_.remote->Rewind();
  parts_.recorder->StartOver();
  const Clock::time_point begin = Clock::now();
  while (SecondsSince(begin) < 5 && (recorder.Finished() || recorder.progress() >= 1)) {
    if (inputs_.start) parts_.remote->HintPose(*inputs_.start);
    parts_.bus->Poll(50);
    // The first order may have been lost.
    if (SecondsSince(begin) > 1 && recorder.progress() >= 1) parts_.remote->Rewind();
  }
  if (inputs_.start) parts_.remote->HintPose(*inputs_.start);
}

void Player::PrintLoop(int loop) const {
  const Recorder& recorder = *parts_.recorder;
  const TrajectoryError error = AbsoluteError(inputs_.truth, recorder.online(), Alignment::kNone);
  char ate[32] = "-";
  if (error.scored()) std::snprintf(ate, sizeof ate, "%.2f cm", 100 * error.position_rmse);
  std::printf("loop %d: %zu poses, ATE %s, %s\n", loop, recorder.online().size(), ate,
              recorder.mode().reason.c_str());
  std::fflush(stdout);
}

}  // namespace evit::run
