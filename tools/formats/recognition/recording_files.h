#pragma once

#include <string>
#include <vector>

namespace evit::formats {

/// The files of one recording, by what they hold.
struct RecordingFiles {
  std::vector<std::string> events;  // bags that belong together; or one file and, for HDF5, files beside it
  std::string imu, truth;           // of their own; empty: none
};

/// Looks through a folder and those in it, as data sets publish them (RPG, TUM-VIE, EDS, DSEC, M3ED, MVSEC)
/// or people keep them. `imu`, `truth`: files that are chosen already; empty: to be found. Throws
/// std::runtime_error naming the files where there are no events, or several recordings.
RecordingFiles FindRecording(const std::string& folder, const std::string& imu = "",
                             const std::string& truth = "");

/// The same of files that a user lists, in any order: tables of an IMU and of poses beside the events are
/// told by their contents. Throws std::runtime_error naming what holds neither, and what is there twice.
RecordingFiles SortRecording(const std::vector<std::string>& paths, const std::string& imu = "",
                             const std::string& truth = "");

}  // namespace evit::formats
