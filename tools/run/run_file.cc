#include "tools/run/run_file.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

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
  const std::vector<RunningPipeline> all = FindAllRunning();
  return all.empty() ? std::nullopt : std::optional(all.front());
}

std::vector<RunningPipeline> FindAllRunning() {
  std::error_code ignored;
  std::vector<std::pair<std::filesystem::file_time_type, RunningPipeline>> all;
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
    all.emplace_back(std::filesystem::last_write_time(entry.path(), ignored), found);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<RunningPipeline> pipelines;
  pipelines.reserve(all.size());
  for (auto& [time, pipeline] : all) pipelines.push_back(std::move(pipeline));
  return pipelines;
}

RunningPipeline ChooseRunning(pid_t pid) {
  const std::vector<RunningPipeline> all = FindAllRunning();
  if (all.empty()) {
    throw std::runtime_error(
        "neither `evit run` nor `evit up` is running on this host; give --lcm-url to reach another one");
  }
  std::string list;
  for (const RunningPipeline& pipeline : all) {
    if (pipeline.pid == pid || (pid == 0 && all.size() == 1)) return pipeline;
    list += (list.empty() ? "" : ", ") + std::to_string(pipeline.pid) + " (" + pipeline.logs + ")";
  }
  throw std::runtime_error(
      (pid == 0 ? "several pipelines are running on this host" : "no pipeline has that process id") +
      std::string("; choose one with --pid: ") + list);
}

}  // namespace evit::run
