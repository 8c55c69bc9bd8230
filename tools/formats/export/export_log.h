#pragma once

#include <functional>
#include <string>

namespace evit::formats {

enum class ExportFormat { kRpg, kDsec, kEvt3 };

struct LogExport {
  std::string log, out;  // out: a folder for RPG's text, else the file of the events
  ExportFormat format = ExportFormat::kRpg;
  bool allow_truncated = false;  // of a log that was cut off: what is whole of it is written
  int width = 0, height = 0;     // of the sensor, for EVT3's header; 0: what holds all events
};

struct ExportSummary {
  std::int64_t n_events = 0, n_imu = 0, n_truth = 0;
};

/// A log of `evit import` as other tools read it: RPG's folder of text files (events.txt, imu.txt,
/// groundtruth.txt), DSEC's HDF5 (t_offset is the first event's stamp), or Metavision RAW, EVT 3.0 (its
/// stamps count from the first event). Beside the latter two, OUT.imu.txt and OUT.groundtruth.txt in RPG's
/// layout, on the clock of the events file. Each file appears whole or not at all. Throws std::runtime_error
/// naming file and reason.
ExportSummary ExportLog(const LogExport& job, const std::function<void(double)>& progress);

}  // namespace evit::formats
