#include "procman/managed_process.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>

#include "procman/launched_process.h"

namespace evit::procman {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstDelay{10}, kLongestDelay{1000};
constexpr milliseconds kEarly{1000};  // a run that lasts longer was a good one

double Seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

std::string LogFile(const std::string& folder, std::string id) {
  if (folder.empty()) return "";
  std::replace(id.begin(), id.end(), '/', '_');
  return (std::filesystem::path(folder) / (id + ".log")).string();
}

}  // namespace

ManagedProcess::ManagedProcess(ProcmanCommand command, Places places, Sink sink)
    : command_(std::move(command)),
      places_(std::move(places)),
      sink_(std::move(sink)),
      output_(LogFile(places_.logs, command_.id)) {}

ManagedProcess::~ManagedProcess() {
  if (pid_ > 0) {
    Signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

void ManagedProcess::Signal(int signal) const {
  // Its whole group: what a wrapper script started too. The group may not be there yet right after the start.
  if (kill(-pid_, signal) != 0) kill(pid_, signal);
}

void ManagedProcess::Start() {
  if (state_ == State::kStopping) {
    start_again_ = true;
    return;
  }
  if (pid_ > 0) return;
  delay_ = milliseconds(0);
  early_deaths_ = 0;
  Launch();
}

void ManagedProcess::Stop() {
  start_again_ = false;
  died_ = false;
  if (state_ == State::kWaiting) state_ = State::kStopped;
  if (state_ != State::kRunning) return;
  state_ = State::kStopping;
  Signal(command_.stop_signal);
  kill_at_ = Clock::now() + milliseconds(static_cast<int>(1000 * command_.stop_time_allowed));
}

void ManagedProcess::Restart() {
  Stop();
  Start();
}

void ManagedProcess::Say(const std::string& text) { sink_(command_.id, text + '\n'); }

void ManagedProcess::Tick() {
  const Clock::time_point now = Clock::now();
  if (pid_ > 0) {
    ReadOutput();
    Reap();
    if (state_ == State::kStopping && now >= kill_at_) {
      Say("still running " + std::to_string(static_cast<int>(command_.stop_time_allowed)) +
          " s after signal " + std::to_string(command_.stop_signal) + ": killing it");
      Signal(SIGKILL);
      kill_at_ = now + kLongestDelay;
    }
  }
  if (state_ != State::kWaiting || now < start_at_) return;
  try {
    Launch();
  } catch (const std::exception& error) {
    Say(std::string("cannot be restarted: ") + error.what());
    delay_ = std::clamp(2 * delay_, kFirstDelay, kLongestDelay);
    start_at_ = now + delay_;
    ++early_deaths_;
  }
}

void ManagedProcess::Launch() {
  const LaunchedProcess launched = LaunchProcess(command_.id, command_.exec, places_.programs);
  output_.Open(launched.output);
  pid_ = launched.pid;
  state_ = State::kRunning;
  died_ = false;
  started_ = Clock::now();
  ++runs_;
}

void ManagedProcess::ReadOutput() {
  output_.Read([this](const std::string& text) { sink_(command_.id, text); });
}

void ManagedProcess::Reap() {
  rusage usage{};
  if (wait4(pid_, &ended_.status, WNOHANG, &usage) != pid_) return;
  ReadOutput();  // the rest of it
  output_.Close();
  ended_.cpu_seconds += Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  ended_.peak_mb = std::max(ended_.peak_mb, static_cast<double>(usage.ru_maxrss) / 1024);
  kill(-pid_, SIGKILL);  // what it started and left behind
  pid_ = 0;
  const Clock::time_point now = Clock::now();
  if (state_ == State::kStopping) {
    state_ = std::exchange(start_again_, false) ? State::kWaiting : State::kStopped;
    start_at_ = now;
    return;
  }
  const bool early = now - started_ < kEarly;
  early_deaths_ = early ? early_deaths_ + 1 : 0;
  state_ = command_.auto_respawn ? State::kWaiting : State::kStopped;
  died_ = true;
  if (!command_.auto_respawn) {
    Say("ended with " + end());
    return;
  }
  delay_ = early ? std::clamp(2 * delay_, kFirstDelay, kLongestDelay) : kFirstDelay;
  start_at_ = now + delay_;
  Say("died with " + end() + "; restarting it in " + std::to_string(delay_.count()) + " ms");
}

std::string ManagedProcess::end() const {
  if (runs_ == 0) return "never started";
  if (WIFSIGNALED(ended_.status)) {
    return "signal " + std::to_string(WTERMSIG(ended_.status)) + " (" + strsignal(WTERMSIG(ended_.status)) +
           ")";
  }
  return "exit code " + std::to_string(WEXITSTATUS(ended_.status));
}

int ManagedProcess::exit_code() const {
  return WIFSIGNALED(ended_.status) ? 128 + WTERMSIG(ended_.status) : WEXITSTATUS(ended_.status);
}

}  // namespace evit::procman
