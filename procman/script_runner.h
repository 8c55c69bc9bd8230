#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "procman/deployment.h"
#include "procman/supervisor.h"

namespace evit::procman {

/// Runs a script of a deployment step by step, without ever blocking.
class ScriptRunner {
 public:
  /// Steps of commands that `supervisor` does not have (another deputy's) are left out. All must outlive
  /// this.
  ScriptRunner(const Deployment& deployment, Supervisor* supervisor);

  /// Throws std::runtime_error, listing those there are, where there is no such script.
  void Run(const std::string& script);

  /// Call often: does what is due. Throws std::runtime_error where a command cannot be started.
  void Tick();
  bool done() const { return next_ == steps_.size(); }

 private:
  void Append(const std::string& script);
  bool Do(const ScriptStep& step);
  bool Reached(const ScriptStep& step) const;

  const Deployment& deployment_;
  Supervisor* supervisor_;
  std::vector<ScriptStep> steps_;  // scripts run by scripts put in their place
  std::size_t next_ = 0;
  bool acted_ = false;  // the next step has been ordered and is being waited for
  std::chrono::steady_clock::time_point since_;
};

}  // namespace evit::procman
