#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "procman/deputy.h"

namespace evit::run {

/// The services of one run, under a deputy of their own. They end with this object.
class Pipeline {
 public:
  struct Death {
    std::string service;
    std::chrono::steady_clock::time_point at;
  };

  /// Starts `services` in their order. `deputy`: its id on PM_INFO. `programs`: folder of the executables;
  /// `logs`: folder for NAME.log, what each one says. `bus` must outlive this. Throws std::runtime_error
  /// where one cannot be started.
  Pipeline(Bus* bus, const std::string& deputy, const std::vector<procman::ProcmanCommand>& services,
           const std::string& programs, const std::string& logs);

  /// Call often. Throws std::runtime_error, with its last output, where a service that is not to be restarted
  /// has died, or one dies at every start.
  void Watch();

  /// Ends each, the last one started first: the sources go before those who wait for them.
  void Stop() { deputy_.supervisor().StopAll(); }

  /// Those that died and were started again.
  const std::vector<Death>& deaths() const { return deaths_; }
  const std::vector<std::unique_ptr<procman::ManagedProcess>>& processes() const { return processes_; }

 private:
  procman::Deputy deputy_;
  const std::vector<std::unique_ptr<procman::ManagedProcess>>& processes_;
  std::vector<int> runs_;  // of each process, seen so far
  std::vector<Death> deaths_;
};

}  // namespace evit::run
