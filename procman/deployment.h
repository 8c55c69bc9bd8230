#pragma once

#include <string>
#include <vector>

namespace evit::procman {

/// One command of a deployment: what it is and how it is to be stopped.
struct ProcmanCommand {
  std::string id;
  std::string exec;              // command line, see SplitCommandLine
  std::string deputy;            // who runs it
  std::string group;             // "a/b": group b inside group a; empty: none
  bool auto_respawn = false;     // restarted when it ends by itself
  int stop_signal = 2;           // SIGINT
  double stop_time_allowed = 7;  // s from that signal to SIGKILL
};

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
