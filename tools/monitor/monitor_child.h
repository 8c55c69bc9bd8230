#pragma once

#include <sys/types.h>

#include <string>

#include "tools/monitor/monitor.h"

namespace evit::monitor {

/// Where viewers find a monitor, e.g. "http://127.0.0.1:8080".
std::string PageUrl(const MonitorOptions& options);

/// Says on stdout where the page is, and on stderr if it was not built.
void SayUrl(const MonitorOptions& options, const char* hint);

/// Opens the page in the user's browser, where there is a desktop; else does nothing.
void OpenBrowser(const std::string& url);

/// A monitor in a process of its own that shows the pipeline which this process is about to run. Ends with
/// this object, or with this process.
class MonitorChild {
 public:
  /// Call before any thread is made and before the network namespace is changed. Throws std::runtime_error
  /// where no process can be made.
  MonitorChild(MonitorOptions options, const std::string& lcm_url);
  ~MonitorChild();
  MonitorChild(const MonitorChild&) = delete;
  MonitorChild& operator=(const MonitorChild&) = delete;

  /// Until SIGINT or SIGTERM comes, or the monitor has ended.
  void WaitForSignal() const;

 private:
  pid_t pid_;
};

}  // namespace evit::monitor
