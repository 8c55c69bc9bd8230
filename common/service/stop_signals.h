#pragma once

#include <csignal>

namespace evit {

/// Turns SIGINT, SIGTERM and SIGHUP (the terminal is gone) into a flag while it lives, then puts back what
/// was there. One at a time in a process.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one has come. Calls into the system are taken up again after it (SA_RESTART): wait with a
  /// time-out.
  bool received() const;

 private:
  struct sigaction old_int_ = {};
  struct sigaction old_term_ = {};
  struct sigaction old_hup_ = {};
};

}  // namespace evit
