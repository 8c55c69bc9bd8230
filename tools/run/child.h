#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace evit {

/// A child process whose output goes to a file. It dies with this process, whatever happens.
class Child {
 public:
  /// `program`: path; `arguments`: without the program's own name; `log`: file for stdout and stderr
  /// (appended). Throws std::runtime_error where it cannot be started.
  Child(std::string name, std::string program, std::vector<std::string> arguments, std::string log);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Starts it again after it has ended.
  void Start();

  /// Looks whether it still runs; after its end, exit() and usage() tell how it went.
  bool Running();

  /// SIGINT, and SIGKILL where it has not ended after `patience_ms`.
  void Stop(int patience_ms = 2000);

  const std::string& name() const { return name_; }
  pid_t pid() const { return pid_; }
  /// "exit code 1" or "signal 11 (Segmentation fault)".
  std::string end() const;
  bool ended_well() const;
  /// CPU seconds and peak memory of all its runs.
  double cpu_seconds() const { return cpu_seconds_; }
  double peak_mb() const { return peak_mb_; }
  /// The last lines it said.
  std::string LastWords(int lines = 3) const;

 private:
  std::string name_, program_, log_;
  std::vector<std::string> arguments_;
  pid_t pid_ = -1;
  bool running_ = false;
  int status_ = 0;
  double cpu_seconds_ = 0, peak_mb_ = 0;
};

}  // namespace evit
