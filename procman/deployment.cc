#include "procman/deployment.h"

#include <algorithm>
#include <stdexcept>

namespace evit::procman {
namespace {

bool InGroup(const ProcmanCommand& command, const std::string& group) {
  return command.group == group || command.group.compare(0, group.size() + 1, group + "/") == 0;
}

}  // namespace

const ProcmanCommand* Deployment::Find(const std::string& id) const {
  const auto it = std::find_if(commands.begin(), commands.end(), [&](const auto& c) { return c.id == id; });
  return it == commands.end() ? nullptr : &*it;
}

const ProcmanScript* Deployment::FindScript(const std::string& name) const {
  const auto it = std::find_if(scripts.begin(), scripts.end(), [&](const auto& s) { return s.name == name; });
  return it == scripts.end() ? nullptr : &*it;
}

std::vector<std::string> Deployment::Targets(const ScriptStep& step) const {
  if (!step.whole_group) return {step.target};
  std::vector<std::string> ids;
  for (const ProcmanCommand& command : commands) {
    if (InGroup(command, step.target)) ids.push_back(command.id);
  }
  return ids;
}

}  // namespace evit::procman
