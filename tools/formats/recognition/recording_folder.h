#pragma once

#include <string>
#include <vector>

namespace evit::formats {

/// The files of a recording in a folder, as data sets publish them (RPG, TUM-VIE, EDS, DSEC, M3ED, MVSEC).
struct RecordingFiles {
  std::vector<std::string> events;  // and, for HDF5, files beside them
  std::string imu, truth;           // text tables; empty: none
};

/// Looks through a folder and those in it. Throws std::runtime_error where there are no events, or several
/// recordings.
RecordingFiles FindRecording(const std::string& folder);

}  // namespace evit::formats
