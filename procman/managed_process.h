#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>

#include "procman/process_output.h"
#include "procman/procman_command.h"

namespace evit::procman {

/// One command as a process: started, asked to stop, killed if it does not, and restarted with a growing
/// delay if it dies by itself. It never outlives this process: the kernel sees to that.
class ManagedProcess {
 public:
  using Clock = std::chrono::steady_clock;
  /// Receives its output (stdout and stderr), and messages about it.
  using Sink = std::function<void(const std::string& id, const std::string& text)>;

  struct Places {
    std::string programs;  // folder searched before PATH; empty: none
    std::string logs;      // folder for ID.log, appended to; empty: none
  };
  enum class State {
    kStopped,
    kRunning,
    kStopping,  // asked to end
    kWaiting,   // died; is started again after the delay
  };

  ManagedProcess(ProcmanCommand command, Places places, Sink sink);
  ~ManagedProcess();
  ManagedProcess(const ManagedProcess&) = delete;
  ManagedProcess& operator=(const ManagedProcess&) = delete;

  /// Starts a new run unless one runs. Throws std::runtime_error where that is impossible: no such program, a
  /// variable that is not set, no process left.
  void Start();
  /// Asks it to stop; Tick() kills it after stop_time_allowed.
  void Stop();
  /// Stop, then Start as soon as it has ended.
  void Restart();

  /// Call often: reads its output, notices its end, kills and starts again what is due.
  void Tick();

  const ProcmanCommand& command() const { return command_; }
  State state() const { return state_; }
  bool running() const { return pid_ > 0; }
  pid_t pid() const { return pid_; }  // 0: not running
  int runs() const { return runs_; }  // started so far
  /// The last run ended by itself, and there has been none since.
  bool died() const { return died_; }
  /// Lives in a row that ended by themselves within a second.
  int early_deaths() const { return early_deaths_; }
  /// How the last run ended: "exit code 1" or "signal 11 (Segmentation fault)"; as a number like a shell's.
  std::string end() const;
  int exit_code() const;
  bool ended_well() const { return runs_ > 0 && pid_ == 0 && ended_.status == 0; }
  /// CPU seconds and peak memory (MB) of all ended runs.
  double cpu_seconds() const { return ended_.cpu_seconds; }
  double peak_mb() const { return ended_.peak_mb; }
  /// The last lines of its output.
  std::string LastWords(int lines = 3) const { return output_.LastLines(lines); }

 private:
  /// The runs that have ended.
  struct Ended {
    int status = 0;                       // of the last one, as wait(2) gives it
    double cpu_seconds = 0, peak_mb = 0;  // of all
  };

  void Launch();
  void ReadOutput();
  void Reap();
  void Signal(int signal) const;
  void Say(const std::string& text);

  ProcmanCommand command_;
  Places places_;
  Sink sink_;
  State state_ = State::kStopped;
  pid_t pid_ = 0;
  ProcessOutput output_;
  int runs_ = 0, early_deaths_ = 0;
  bool start_again_ = false;  // Restart
  bool died_ = false;         // the last run ended by itself
  Clock::time_point started_, kill_at_, start_at_;
  std::chrono::milliseconds delay_{0};
  Ended ended_;
};

}  // namespace evit::procman
