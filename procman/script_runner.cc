#include "procman/script_runner.h"

#include <stdexcept>

namespace evit::procman {

ScriptRunner::ScriptRunner(const Deployment& deployment, Supervisor* supervisor)
    : deployment_(deployment), supervisor_(supervisor) {}

void ScriptRunner::Append(const std::string& script) {
  for (const ScriptStep& step : deployment_.FindScript(script)->steps) {
    // No loops: the parser refuses them.
    step.kind == ScriptStep::Kind::kRunScript ? Append(step.target) : steps_.push_back(step);
  }
}

void ScriptRunner::Run(const std::string& script) {
  if (deployment_.FindScript(script) == nullptr) {
    std::string known;
    for (const ProcmanScript& s : deployment_.scripts) known += (known.empty() ? "" : ", ") + s.name;
    throw std::runtime_error("there is no script \"" + script +
                             "\"; there are: " + (known.empty() ? "none" : known));
  }
  steps_.clear();
  next_ = 0;
  acted_ = false;
  Append(script);
}

void ScriptRunner::Tick() {
  while (!done() && Do(steps_[next_])) {
    ++next_;
    acted_ = false;
  }
}

// True when the step is over.
bool ScriptRunner::Do(const ScriptStep& step) {
  if (!acted_) {
    acted_ = true;
    since_ = std::chrono::steady_clock::now();
    for (const std::string& id : deployment_.Targets(step)) {
      if (supervisor_->Find(id) == nullptr) continue;
      if (step.kind == ScriptStep::Kind::kStart) supervisor_->Start(id);
      if (step.kind == ScriptStep::Kind::kStop) supervisor_->Stop(id);
      if (step.kind == ScriptStep::Kind::kRestart) supervisor_->Restart(id);
    }
  }
  if (step.kind == ScriptStep::Kind::kWaitMs) {
    return std::chrono::steady_clock::now() - since_ >= std::chrono::milliseconds(step.wait_ms);
  }
  return step.wait.empty() || Reached(step);
}

bool ScriptRunner::Reached(const ScriptStep& step) const {
  for (const std::string& id : deployment_.Targets(step)) {
    const ManagedProcess* process = supervisor_->Find(id);
    if (process == nullptr) continue;
    const bool stopped = process->state() == ManagedProcess::State::kStopped;
    if (step.wait == "stopped" ? !stopped : !process->running()) return false;
  }
  return true;
}

}  // namespace evit::procman
