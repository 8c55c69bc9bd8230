#include "procman/managed_process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace evit::procman {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstDelay{10}, kLongestDelay{1000};
constexpr milliseconds kEarly{1000};  // a run that lasts longer was a good one
constexpr std::size_t kWords = 4096;  // bytes of output kept for last words
constexpr int kOutputPerTick =
    1 << 18;  // bytes: a command that never stops talking does not hold up the others

double Seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

ManagedProcess::ManagedProcess(ProcmanCommand command, Places places, Sink sink)
    : command_(std::move(command)), places_(std::move(places)), sink_(std::move(sink)) {
  if (places_.logs.empty()) return;
  std::string name = command_.id;
  std::replace(name.begin(), name.end(), '/', '_');
  const std::string path = (std::filesystem::path(places_.logs) / (name + ".log")).string();
  log_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  if (log_ < 0) throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
}

ManagedProcess::~ManagedProcess() {
  if (pid_ > 0) {
    Signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (output_ >= 0) close(output_);
  if (log_ >= 0) close(log_);
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
      Say("still runs " + std::to_string(static_cast<int>(command_.stop_time_allowed)) + " s after signal " +
          std::to_string(command_.stop_signal) + ": killing it");
      Signal(SIGKILL);
      kill_at_ = now + kLongestDelay;
    }
  }
  if (state_ != State::kWaiting || now < start_at_) return;
  try {
    Launch();
  } catch (const std::exception& error) {
    Say(std::string("cannot be started again: ") + error.what());
    delay_ = std::clamp(2 * delay_, kFirstDelay, kLongestDelay);
    start_at_ = now + delay_;
    ++early_deaths_;
  }
}

void ManagedProcess::ReadOutput() {
  std::array<char, 16384> buffer{};
  for (int taken = 0; taken < kOutputPerTick;) {
    const ssize_t n = read(output_, buffer.data(), buffer.size());
    if (n <= 0) return;
    taken += static_cast<int>(n);
    const std::string text(buffer.data(), static_cast<std::size_t>(n));
    // A full disk must not stop the command: only the copy of this output in the file is lost.
    if (log_ >= 0 && write(log_, text.data(), text.size()) < 0) errno = 0;
    last_words_ += text;
    if (last_words_.size() > kWords) last_words_.erase(0, last_words_.size() - kWords);
    sink_(command_.id, text);
  }
}

void ManagedProcess::Reap() {
  rusage usage{};
  if (wait4(pid_, &status_, WNOHANG, &usage) != pid_) return;
  ReadOutput();  // its last words
  close(output_);
  output_ = -1;
  cpu_seconds_ += Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  peak_mb_ = std::max(peak_mb_, static_cast<double>(usage.ru_maxrss) / 1024);
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
  Say("died with " + end() + "; starting it again in " + std::to_string(delay_.count()) + " ms");
}

std::string ManagedProcess::end() const {
  if (runs_ == 0) return "never started";
  if (WIFSIGNALED(status_)) {
    return "signal " + std::to_string(WTERMSIG(status_)) + " (" + strsignal(WTERMSIG(status_)) + ")";
  }
  return "exit code " + std::to_string(WEXITSTATUS(status_));
}

int ManagedProcess::exit_code() const {
  return WIFSIGNALED(status_) ? 128 + WTERMSIG(status_) : WEXITSTATUS(status_);
}

std::string ManagedProcess::LastWords(int lines) const {
  std::string words = last_words_;
  while (!words.empty() && words.back() == '\n') words.pop_back();
  std::size_t begin = words.size();
  for (; lines > 0 && begin != std::string::npos && begin > 0; --lines) begin = words.rfind('\n', begin - 1);
  words.erase(0, begin == std::string::npos || begin == 0 ? 0 : begin + 1);
  if (words.empty()) return "";
  std::string text;
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find('\n', at), words.size());
    text += "\n  " + words.substr(at, end - at);
    at = end + 1;
  }
  return text;
}

}  // namespace evit::procman
