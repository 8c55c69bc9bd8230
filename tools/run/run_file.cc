#include "tools/run/run_file.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace evit::run {

namespace {

std::filesystem::path RunFolder() {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder != nullptr && std::filesystem::is_directory(folder))
    return std::filesystem::path(folder) / "evit";
  return std::filesystem::path("/tmp") / ("evit-" + std::to_string(getuid()));
}

}  // namespace

RunFile::RunFile(const std::string& logs) {
  std::error_code ignored;  // only convenience hangs on this file
  std::filesystem::create_directories(RunFolder(), ignored);
  FindRunning();  // clears away what killed processes left
  path_ = (RunFolder() / ("run-" + std::to_string(getpid()))).string();
  std::ofstream(path_) << getpid() << '\n' << std::filesystem::absolute(logs, ignored).string() << '\n';
}

RunFile::~RunFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

std::optional<RunningPipeline> FindRunning() {
  std::error_code ignored;
  std::optional<RunningPipeline> newest;
  std::filesystem::file_time_type newest_time;
  for (const auto& entry : std::filesystem::directory_iterator(RunFolder(), ignored)) {
    RunningPipeline found;
    std::ifstream file(entry.path());
    file >> found.pid >> std::ws;
    std::getline(file, found.logs);
    if (found.pid <= 0) continue;
    if (kill(found.pid, 0) != 0 && errno == ESRCH) {
      std::filesystem::remove(entry.path(), ignored);
      continue;
    }
    const auto time = std::filesystem::last_write_time(entry.path(), ignored);
    if (newest && time < newest_time) continue;
    newest = found;
    newest_time = time;
  }
  return newest;
}

}  // namespace evit::run
