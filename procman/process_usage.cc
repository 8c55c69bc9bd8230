#include "procman/process_usage.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace evit::procman {

ProcessUsage ReadProcessUsage(pid_t pid) {
  ProcessUsage usage;
  const std::string folder = "/proc/" + std::to_string(pid);
  std::ifstream file(folder + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t name_end = text.rfind(')');  // a name may hold anything, also spaces and ')'
  if (name_end == std::string::npos) return usage;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int k = 0; k < 11; ++k) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  usage.cpu_seconds = (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  std::int64_t vsize = 0, rss = 0;
  std::ifstream(folder + "/statm") >> vsize >> rss;
  usage.vsize_bytes = vsize * sysconf(_SC_PAGESIZE);
  usage.rss_bytes = rss * sysconf(_SC_PAGESIZE);
  return usage;
}

double ReadProcessorWait(pid_t pid) {
  double seconds = 0;
  std::error_code gone;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task", gone)) {
    double running = 0, waiting = 0;  // ns
    if (std::ifstream(task.path() / "schedstat") >> running >> waiting) seconds += 1e-9 * waiting;
  }
  return seconds;
}

HostUsage ReadHostUsage() {
  HostUsage usage;
  std::ifstream stat("/proc/stat");
  std::string word;
  stat >> word;
  for (int k = 0; k < 8; ++k) {
    double ticks = 0;
    stat >> ticks;
    const double seconds = ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    usage.total_seconds += seconds;
    if (k != 3 && k != 4) usage.busy_seconds += seconds;  // idle and waiting for the disk
  }
  std::ifstream memory("/proc/meminfo");
  std::string unit;
  std::int64_t kilobytes = 0;
  while (memory >> word >> kilobytes) {
    std::getline(memory, unit);
    if (word == "MemTotal:") usage.memory_total_bytes = kilobytes * 1024;
    if (word == "MemAvailable:") usage.memory_free_bytes = kilobytes * 1024;
    if (word == "SwapTotal:") usage.swap_total_bytes = kilobytes * 1024;
    if (word == "SwapFree:") usage.swap_free_bytes = kilobytes * 1024;
  }
  return usage;
}

}  // namespace evit::procman
