#pragma once

#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/log_file.h"

namespace evit::run {

/// Writes what comes on some channels to an LCM log, as lcm-logger would, with the host's time of arrival.
/// When the disk is full the run continues and Close() reports it.
class BusLog {
 public:
  /// `bus` must outlive this. Throws std::runtime_error where the file cannot be made.
  BusLog(Bus* bus, const std::string& path, const std::vector<std::string>& channels);

  /// Throws std::runtime_error naming the file where not everything could be written.
  void Close();

 private:
  LogWriter log_;
  std::string error_;
};

}  // namespace evit::run
