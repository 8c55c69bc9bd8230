#pragma once

#include <string>
#include <vector>

#include "procman/procman_command.h"

namespace evit::procman {

/// One action of a script.
struct ScriptStep {
  enum class Kind { kStart, kStop, kRestart, kWaitMs, kWaitStatus, kRunScript };
  Kind kind = Kind::kStart;
  bool whole_group = false;  // target is a group
  std::string target;        // command, group or script
  std::string wait;          // "running", "stopped"; empty: do not wait
  int wait_ms = 0;           // kWaitMs
};

struct ProcmanScript {
  std::string name;
  std::vector<ScriptStep> steps;
};

/// A procman file.
struct Deployment {
  std::vector<ProcmanCommand> commands;  // in the order of the file
  std::vector<ProcmanScript> scripts;

  const ProcmanCommand* Find(const std::string& id) const;
  const ProcmanScript* FindScript(const std::string& name) const;
  /// Ids a step means: one command, or all of a group and the groups inside it.
  std::vector<std::string> Targets(const ScriptStep& step) const;
};

/// Reads either dialect: `deputy = "..."` (procman) and `host = "..."` (bot-procman). `file`: for messages.
/// Throws std::runtime_error naming file, line, what was found and what was expected; also where an id occurs
/// twice, or a script means something that is not there or itself.
Deployment ParseDeployment(const std::string& text, const std::string& file);

/// The same from a file.
Deployment LoadDeployment(const std::string& path);

}  // namespace evit::procman
