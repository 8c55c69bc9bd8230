#include "tools/monitor/monitor_child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/service/stop_signals.h"
#include "tools/monitor/monitor_process.h"
#include "tools/monitor/page_files.h"

namespace evit::monitor {

std::string PageUrl(const MonitorOptions& options) {
  const std::string host = options.web.bind == "0.0.0.0" ? "127.0.0.1" : options.web.bind;
  return "http://" + host + ":" + std::to_string(options.web.port);
}

void SayUrl(const MonitorOptions& options, const char* hint) {
  std::printf("monitor: %s%s\n", PageUrl(options).c_str(), hint);
  std::fflush(stdout);
  const std::string missing = MissingPage(PageFolder());
  if (!missing.empty()) std::fprintf(stderr, "monitor: warning: %s\n", missing.c_str());
}

void OpenBrowser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  const pid_t child = fork();
  if (child != 0) {
    if (child > 0) waitpid(child, nullptr, 0);
    return;
  }
  if (fork() != 0) _exit(0);  // the browser is nobody's child
  const int null = open("/dev/null", O_RDWR);
  for (const int fd : {0, 1, 2}) dup2(null, fd);
  execlp("xdg-open", "xdg-open", url.c_str(), nullptr);
  _exit(1);
}

MonitorChild::MonitorChild(MonitorOptions options, const std::string& lcm_url) : pid_(0) {
  const pid_t parent = getpid();
  options.pipeline = parent;
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot start a process for the monitor");
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(0);
  setpgid(0, 0);  // Ctrl-C is for the run; this ends with it
  int code = 1;
  try {
    code = MonitorProcess(std::move(options), lcm_url).Run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "monitor: error: %s\n", error.what());
  }
  std::fflush(nullptr);
  _exit(code);
}

MonitorChild::~MonitorChild() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

void MonitorChild::WaitForSignal() const {
  const StopSignals signals;
  siginfo_t ended{};
  while (!signals.received() && ended.si_pid == 0) {
    waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace evit::monitor
