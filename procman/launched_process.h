#pragma once

#include <sys/types.h>

#include <string>

namespace evit::procman {

/// A process that has just been started, in a process group of its own.
struct LaunchedProcess {
  pid_t pid = 0;
  int output = -1;  // read end of its stdout and stderr, non-blocking; the caller closes it
};

/// Starts the command line `exec` (see SplitCommandLine). Its program is searched in the folder `programs`
/// (unless empty), then on PATH. The kernel kills it when this process dies. `id`: for messages. Throws
/// std::runtime_error: no such program, a variable that is not set, no process left.
LaunchedProcess LaunchProcess(const std::string& id, const std::string& exec, const std::string& programs);

}  // namespace evit::procman
