#pragma once

#include <sys/types.h>

#include <cstdint>

namespace evit::procman {

/// What a running process uses, from /proc; zeros where it is gone.
struct ProcessUsage {
  double cpu_seconds = 0;  // since its start
  std::int64_t vsize_bytes = 0, rss_bytes = 0;
};
ProcessUsage ReadProcessUsage(pid_t pid);

/// Seconds for which its threads were ready to run and had no processor, added up since their start; zero
/// where the kernel does not tell.
double ReadProcessorWait(pid_t pid);

struct HostUsage {
  double busy_seconds = 0, total_seconds = 0;  // of all cores, since boot
  std::int64_t memory_total_bytes = 0, memory_free_bytes = 0, swap_total_bytes = 0, swap_free_bytes = 0;
};
HostUsage ReadHostUsage();

}  // namespace evit::procman
