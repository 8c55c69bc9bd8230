#pragma once

#include <functional>
#include <string>

namespace evit::procman {

/// What a command prints on stdout and stderr, over all its runs: passed on, copied into its log file, and
/// the end of it kept.
class ProcessOutput {
 public:
  using Sink = std::function<void(const std::string&)>;

  /// `log`: file to write; empty: none. Throws std::runtime_error where it cannot be written.
  explicit ProcessOutput(const std::string& log);
  ~ProcessOutput();
  ProcessOutput(const ProcessOutput&) = delete;
  ProcessOutput& operator=(const ProcessOutput&) = delete;

  /// A run begins; takes the read end of its output.
  void Open(int read_end);
  /// Passes on what has come since, without waiting for more.
  void Read(const Sink& sink);
  /// The run has ended.
  void Close();

  /// The last lines, each behind a line break and two blanks; empty where there are none.
  std::string LastLines(int lines) const;

 private:
  int read_end_ = -1, log_ = -1;
  std::string last_;
};

}  // namespace evit::procman
