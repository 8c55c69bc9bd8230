#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace evit::monitor {

/// What the services of a pipeline on this host were given, as the kernel knows their command lines; nothing
/// on the bus can name a file.
struct LocalFiles {
  std::string map, rig;              // absolute; empty: not found
  std::optional<std::string> start;  // pose as text, empty without one; nullopt: no tracker was found

  bool complete() const { return !map.empty() && !rig.empty() && start; }
};

/// `supervisor`: process of `evit run` or `evit up`, whose children the services are.
LocalFiles FindLocalFiles(pid_t supervisor);

/// Those of the services of this user on the bus `url` (as ResolveLcmUrl() gives it), in this process's
/// network, whose channels have `prefix`, whoever started them.
LocalFiles FindLocalFiles(const std::string& url, const std::string& prefix);

/// The value of an option in a command line, as "--map FILE" or "--map=FILE"; empty where it is not there.
std::string OptionValue(const std::vector<std::string>& command_line, const std::string& option);

}  // namespace evit::monitor
