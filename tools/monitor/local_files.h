#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace evit::monitor {

/// Map and rig of a pipeline on this host, as the kernel knows its services' command lines; nothing on the
/// bus can name a file.
struct LocalFiles {
  std::string map, rig;  // absolute; empty: not found
};

/// `supervisor`: process of `evit run` or `evit up`, whose children the services are.
LocalFiles FindLocalFiles(pid_t supervisor);

/// The value of an option in a command line, as "--map FILE" or "--map=FILE"; empty where it is not there.
std::string OptionValue(const std::vector<std::string>& command_line, const std::string& option);

}  // namespace evit::monitor
