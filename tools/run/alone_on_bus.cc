#include "tools/run/alone_on_bus.h"

#include <chrono>
#include <stdexcept>

#include "procman/sheriff.h"

namespace evit::run {

void RequireAlone(Bus* bus, const std::string& id) {
  constexpr std::chrono::milliseconds kPatience(350);
  procman::Sheriff sheriff(bus);
  const auto& deputies = sheriff.Look(kPatience);
  const auto found = deputies.find(id);
  if (found == deputies.end()) return;
  std::string commands;
  for (const auto& status : found->second.cmds) {
    if (status.pid != 0) commands += (commands.empty() ? "" : ", ") + status.cmd.command_id;
  }
  throw std::runtime_error(
      "another pipeline (deputy \"" + id + "\"" + (commands.empty() ? "" : " with " + commands) +
      ") is at work on this bus; both would hear each other: stop it, or give this one --prefix "
      "NAME/ or another port in --lcm-url");
}

}  // namespace evit::run
