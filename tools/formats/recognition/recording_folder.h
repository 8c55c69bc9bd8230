#pragma once

#include <string>
#include <vector>

namespace evit::formats {

/// The files of a recording in a folder, as data sets publish them (RPG, TUM-VIE, EDS, DSEC, M3ED, MVSEC).
struct RecordingFiles {
  std::vector<std::string> events;  // and, for HDF5, files beside them
  std::string imu, truth;           // text tables; empty: none
};

/// Looks through a folder and those in it. `imu`, `truth`: files that are chosen already; empty: to be found.
/// Throws std::runtime_error where there are no events, or several recordings.
RecordingFiles FindRecording(const std::string& folder, const std::string& imu = "",
                             const std::string& truth = "");

}  // namespace evit::formats
