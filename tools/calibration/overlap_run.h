#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/calibration/overlap_calibration.h"

namespace evit::calibration {

/// What a map, a recording and known poses of the body come from.
struct OverlapFiles {
  std::string log, map, truth;                       // truth: TUM, body in the map frame, IMU clock
  std::optional<std::pair<double, double>> seconds;  // part of the truth, from its first pose
};

/// For CalibrateByOverlap: a wide margin, long slices.
MapViewOptions CalibrationViews();

/// The views of these files, some 33 ms apart or farther where the recording is long (the options' step does
/// not count), their events filled in. Throws std::runtime_error naming the file and what is wrong.
/// `between_packets`: called again and again while the log is read; what it throws ends that.
std::vector<MapView> ReadViews(const OverlapFiles& files, const Rig& rig, const Trajectory& body,
                               MapViewOptions options = {},
                               const std::function<void()>& between_packets = {});

/// The poses of the part asked for.
Trajectory ReadTruth(const OverlapFiles& files);

/// The rig with what was found in it.
Rig Calibrated(const Rig& before, const OverlapCalibration& found);

/// What was found, as a table, with the overlap before and after.
std::string OverlapText(const Rig& before, const OverlapCalibration& found);
/// The same as a rig file's comment. `sources`: which files it comes from.
std::string OverlapRigComment(const Rig& before, const OverlapCalibration& found, const std::string& sources);

}  // namespace evit::calibration
