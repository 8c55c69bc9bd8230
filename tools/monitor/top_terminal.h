#pragma once

#include <string>

namespace evit::monitor {

struct TopOptions {
  std::string lcm_url, prefix;
  bool once = false;  // one screen, as plain text, then the end
  int pid = 0;        // of the `evit run` or `evit up` to show; 0: the only one on this host
};

/// `evit top`: shows the pipeline in the terminal, four times a second, until SIGINT or SIGTERM; then the
/// terminal is as it was. Where stdout is not a terminal: as with `once`. Throws std::runtime_error where no
/// bus was named and no pipeline runs on this host, or several and none was chosen.
void ShowTop(const TopOptions& options);

}  // namespace evit::monitor
