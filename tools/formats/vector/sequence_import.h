#pragma once

#include <functional>
#include <string>

#include "common/geometry/rig.h"
#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// A sequence of the VECtor benchmark on disk, to become an LCM log.
struct SequenceImport : ImportTarget {
  std::string folder;  // holds NAME1.synced.left_event.hdf5, .imu.txt and, where known, .gt.txt
  std::string name;    // e.g. "desk_normal"
  Rig rig;             // T_marker_body turns the marker body's ground truth into the IMU's
};

/// The name of the only sequence in a folder. Throws std::runtime_error where there is none, or naming them
/// where there are several.
std::string OnlySequence(const std::string& folder);

/// As ImportLog. An unknown name lists the sequences found.
ImportSummary ImportSequence(const SequenceImport& job, const std::function<void(double)>& progress);

}  // namespace evit::formats
