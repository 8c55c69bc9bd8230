#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace evit::run {

/// Makes sure UDP multicast works on `lo` without ever leaving the host. Where the machine's `lo` has a route
/// to the group of `url` nothing is done; otherwise this process (and all children it starts later) moves
/// into a network namespace of its own, in which `lo` is up and carries multicast. No privileges needed. Call
/// before any thread or socket is made. Returns whether a namespace was made. Throws std::runtime_error with
/// the remedy where the kernel forbids it.
bool EnsureLocalMulticast(const std::string& url);

/// A file that names this process while it lives, so that others (scripts/spy, evit ps) can join its
/// namespace and find its logs: its process id, then the folder of its logs.
class RunFile {
 public:
  explicit RunFile(const std::string& logs);
  ~RunFile();
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

 private:
  std::string path_;
};

/// What the newest live RunFile says; nothing where there is none.
struct RunningPipeline {
  pid_t pid = 0;
  std::string logs;
};
std::optional<RunningPipeline> FindRunning();

/// Moves this process into the network namespace of a running pipeline. Call before any thread or socket is
/// made. Throws std::runtime_error where the kernel forbids it.
void JoinNetworkOf(const RunningPipeline& pipeline);

}  // namespace evit::run
