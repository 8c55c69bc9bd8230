#pragma once

#include <chrono>
#include <string>

#include "common/bus/bus.h"
#include "common/service/stop_signals.h"
#include "tools/run/memory_log.h"
#include "tools/run/pipeline.h"
#include "tools/run/recorder.h"
#include "tools/run/remote.h"
#include "tools/run/run_inputs.h"
#include "tools/run/run_job.h"
#include "tools/run/stall_watch.h"
#include "tools/run/start_signal.h"

namespace evit::run {

/// Waits while the services work through the log, as often as the job asks for, and shows the progress.
class Player {
 public:
  /// What a run consists of; all must outlive the player.
  struct Parts {
    Bus* bus;
    Remote* remote;
    Recorder* recorder;
    Pipeline* pipeline;
    MemoryLog* memory;
  };

  Player(const RunJob& job, const RunInputs& inputs, const Parts& parts);

  /// Returns how it ended: "finished" or "interrupted" (by `signals`). Throws std::runtime_error with the
  /// status of all services where one fails or the tracker falls silent.
  std::string Play(const StopSignals& signals);

 private:
  using Clock = std::chrono::steady_clock;

  std::string WaitForEnd(const StopSignals& signals, StartSignal* start);
  bool Over(const StallWatch& watch) const;
  void RequireHealthy(const StallWatch& watch) const;
  void PlayAgain();
  void PrintLoop(int loop) const;

  const RunJob& job_;
  const RunInputs& inputs_;
  Parts parts_;
};

}  // namespace evit::run
