#include "procman/launched_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "procman/command_line.h"

namespace evit::procman {

namespace {

bool Executable(const std::string& path) { return access(path.c_str(), X_OK) == 0; }

std::string FindProgram(const std::string& name, const std::string& folder) {
  if (name.find('/') != std::string::npos) {
    if (Executable(name)) return name;
    throw std::runtime_error(name + ": no such program; build it first");
  }
  const char* path = std::getenv("PATH");
  const std::string folders = folder + ":" + (path == nullptr ? "/usr/bin:/bin" : path);
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const std::string candidate = folders.substr(begin, end - begin) + "/" + name;
    if (end > begin && Executable(candidate)) return candidate;
    begin = end + 1;
  }
  throw std::runtime_error("no such program as " + name + (folder.empty() ? "" : " in " + folder) +
                           " or on PATH; build it first");
}

// This process's environment with `changes`, as NAME=VALUE.
std::vector<std::string> Environment(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::vector<std::string> result;
  const auto changed = [&](const std::string& entry) {
    for (const auto& [name, value] : changes) {
      if (entry.compare(0, name.size() + 1, name + "=") == 0) return true;
    }
    return false;
  };
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!changed(*entry)) result.emplace_back(*entry);
  }
  for (const auto& [name, value] : changes) result.push_back(name + "=" + value);
  return result;
}

std::vector<char*> Pointers(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

pid_t Fork(const std::string& program, const CommandLine& line, int output) {
  // All memory is made before the fork: other threads may hold the allocator's lock.
  const std::vector<std::string> environment = Environment(line.environment);
  const std::vector<char*> argv = Pointers(line.words), envp = Pointers(environment);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid != 0) return pid;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died in between
  setpgid(0, 0);  // Ctrl-C on the terminal reaches the parent alone, which stops us in order
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execve(program.c_str(), argv.data(), envp.data());
  _exit(127);
}

}  // namespace

LaunchedProcess LaunchProcess(const std::string& id, const std::string& exec, const std::string& programs) {
  const CommandLine line = SplitCommandLine(exec);
  const std::string program = FindProgram(line.words.front(), programs);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw std::runtime_error("cannot start " + id + ": " + std::strerror(errno));
  }
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  const pid_t pid = Fork(program, line, ends[1]);
  const int error = errno;
  close(ends[1]);
  if (pid < 0) {
    close(ends[0]);
    throw std::runtime_error("cannot start " + id + ": " + std::strerror(error));
  }
  return {pid, ends[0]};
}

}  // namespace evit::procman
