#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace evit::run {

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

/// All of them, the newest first.
std::vector<RunningPipeline> FindAllRunning();

/// The one with this process id, or, for 0, the only one. Throws std::runtime_error where none is running, or
/// listing them where there are several to choose from with --pid.
RunningPipeline ChooseRunning(pid_t pid);

}  // namespace evit::run
