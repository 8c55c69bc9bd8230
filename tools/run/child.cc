#include "tools/run/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

namespace evit {

Child::Child(std::string name, std::string program, std::vector<std::string> arguments, std::string log)
    : name_(std::move(name)),
      program_(std::move(program)),
      log_(std::move(log)),
      arguments_(std::move(arguments)) {
  Start();
}

Child::~Child() { Stop(); }

void Child::Start() {
  if (access(program_.c_str(), X_OK) != 0)
    throw std::runtime_error(program_ + ": there is no such program; build it first");
  std::vector<char*> argv{program_.data()};
  for (std::string& argument : arguments_) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int out = open(log_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (out < 0) throw std::runtime_error(log_ + ": cannot be written: " + std::strerror(errno));
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) {
    close(out);
    throw std::runtime_error("cannot start " + name_ + ": " + std::strerror(errno));
  }
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);  // the parent died in between
    setpgid(0, 0);  // Ctrl-C on the terminal reaches the parent alone, which stops us in order
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    execv(program_.c_str(), argv.data());
    _exit(127);
  }
  close(out);
  running_ = true;
}

bool Child::Running() {
  if (!running_) return false;
  rusage usage{};
  if (wait4(pid_, &status_, WNOHANG, &usage) != pid_) return true;
  running_ = false;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  cpu_seconds_ += seconds(usage.ru_utime) + seconds(usage.ru_stime);
  peak_mb_ = std::max(peak_mb_, static_cast<double>(usage.ru_maxrss) / 1024);
  return false;
}

void Child::Stop(int patience_ms) {
  if (!Running()) return;
  kill(pid_, SIGINT);
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms);
  while (Running() && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (running_) {
    kill(pid_, SIGKILL);
    while (Running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::string Child::end() const {
  if (WIFSIGNALED(status_)) {
    return "signal " + std::to_string(WTERMSIG(status_)) + " (" + strsignal(WTERMSIG(status_)) + ")";
  }
  return "exit code " + std::to_string(WEXITSTATUS(status_));
}

bool Child::ended_well() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }

std::string Child::LastWords(int lines) const {
  std::ifstream file(log_);
  std::deque<std::string> last;
  for (std::string line; std::getline(file, line);) {
    last.push_back(line);
    if (last.size() > static_cast<std::size_t>(lines)) last.pop_front();
  }
  std::string text;
  for (const std::string& line : last) text += "\n  " + line;
  return text;
}

}  // namespace evit
