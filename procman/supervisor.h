#pragma once

#include <memory>
#include <string>
#include <vector>

#include "procman/managed_process.h"

namespace evit::procman {

/// All commands of one deputy. They end with this object.
class Supervisor {
 public:
  /// Starts nothing yet. Throws std::runtime_error where a log cannot be written.
  Supervisor(const std::vector<ProcmanCommand>& commands, const ManagedProcess::Places& places,
             const ManagedProcess::Sink& sink);
  ~Supervisor() { StopAll(); }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Null where there is none.
  ManagedProcess* Find(const std::string& id);

  void Start(const std::string& id);
  void Stop(const std::string& id);
  void Restart(const std::string& id);

  /// Call often.
  void Tick();

  /// Ends all, the one started last first, each before the next is asked: those who send go before those who
  /// wait for them. Returns when none runs.
  void StopAll();

  const std::vector<std::unique_ptr<ManagedProcess>>& processes() const { return processes_; }

 private:
  std::vector<std::unique_ptr<ManagedProcess>> processes_;
  std::vector<ManagedProcess*> started_;  // in order
};

}  // namespace evit::procman
