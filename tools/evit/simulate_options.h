#pragma once

#include <string>

#include "tools/simulation/simulation_settings.h"

namespace CLI {
class App;
}

namespace evit::commands {

/// The options of `evit simulate`.
class SimulateOptions {
 public:
  /// Adds all options to the command. This must outlive it.
  void AddTo(CLI::App* command);

  /// The settings they give, once the command line was read.
  simulation::SimulationSettings Settings() const;
  /// The rig file; empty: VECtor's.
  const std::string& rig() const { return rig_; }

 private:
  void AddWorld(CLI::App* command);
  void AddMotion(CLI::App* command);
  void AddSensors(CLI::App* command);
  void AddMap(CLI::App* command);

  simulation::SimulationSettings settings_;
  std::string rig_, frame_ = "auto", room_ = "furnished";
  std::string seconds_, lamp_, dark_, tremor_, holes_,
      carry_;  // numbers with colons between; empty: not given
};

}  // namespace evit::commands
