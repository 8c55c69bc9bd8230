#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "tools/formats/import/import_log.h"
#include "tools/formats/import/recording.h"
#include "tools/formats/recognition/open_recording.h"

namespace evit::formats {

/// A recording of any format that OpenRecording knows, to become an LCM log.
struct RecordingImport : ImportTarget {
  std::vector<std::string> paths;  // files, or one folder
  int width = 0, height = 0;       // of the sensor; 0: as the recording says, or as its events show
  StreamChoice choice;
  std::string imu, truth;     // files with these streams, in place of the recording's; empty: none; "none":
                              // not even the recording's
  double imu_offset = 0;      // s to add to IMU stamps to get the events' clock
  bool align_clocks = false;  // find the offset around that by AlignClocks
  SE3 T_marker_body;          // from the truth's body to the IMU's
};

/// As ImportLog; `found` is told what was recognised as soon as it is (with the size that is used), and may
/// still change T_marker_body.
ImportSummary ImportRecording(const RecordingImport& job,
                              const std::function<void(const RecordingInfo&, SE3* T_marker_body)>& found,
                              const std::function<void(double)>& progress);

}  // namespace evit::formats
