#pragma once

#include <string>

#include "tools/monitor/monitor.h"

namespace evit::monitor {

/// `evit monitor`: serves viewers until SIGINT or SIGTERM.
///
/// The pipeline's bus may live in a network namespace (tools/run/local_network.h), which a process can join
/// but not leave; viewers come from outside. So a worker listens on the port first and joins then, and when
/// another pipeline is to be shown, or a worker has died, the next worker takes its place: pages connect
/// again by themselves.
class MonitorProcess {
 public:
  /// `lcm_url`: empty for the pipeline that runs on this host, now or later.
  MonitorProcess(MonitorOptions options, std::string lcm_url);

  /// Returns the exit code. Throws std::runtime_error where the first worker cannot begin.
  int Run();

 private:
  int Work(bool first);
  int WatchBus();
  int WatchLocal();

  MonitorOptions options_;
  std::string lcm_url_;
};

}  // namespace evit::monitor
