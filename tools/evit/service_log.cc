#include "tools/evit/service_log.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace evit::commands {

std::string LogFileOfCommand(pid_t pid, const std::string& id) {
  pid_t deputy = 0;
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("PPid:", 0) == 0) deputy = std::atoi(line.c_str() + 5);
  }
  if (deputy <= 1) return "";
  std::string name = id + ".log";
  std::replace(name.begin(), name.end(), '/', '_');  // as ManagedProcess names it
  std::error_code error;
  for (const auto& file :
       std::filesystem::directory_iterator("/proc/" + std::to_string(deputy) + "/fd", error)) {
    const std::filesystem::path path = std::filesystem::read_symlink(file.path(), error);
    if (!error && path.filename() == name) return path.string();
  }
  return "";
}

}  // namespace evit::commands
