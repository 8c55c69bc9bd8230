#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/log_file.h"
#include "common/files/staged_file.h"

namespace evit::run {

/// Writes what comes on some channels to an LCM log, as lcm-logger would, with the host's time of arrival.
/// When the disk is full the run continues, nothing of the log is left, and Close() reports it. A run that
/// ends by an error keeps the log of what it had.
class BusLog {
 public:
  /// `bus` must outlive this. Throws std::runtime_error where the file cannot be made.
  BusLog(Bus* bus, const std::string& path, const std::vector<std::string>& channels);
  ~BusLog();

  /// The log gets its name. Throws std::runtime_error naming the file where not everything could be written.
  void Close();

 private:
  void Write(const std::string& channel, const void* data, std::size_t size);
  void Fail(const std::runtime_error& error);

  std::string path_;
  std::optional<StagedFile> file_;  // none: failed
  std::optional<LogWriter> log_;    // none: closed, or failed
  std::string error_;
};

}  // namespace evit::run
