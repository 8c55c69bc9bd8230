#pragma once

#include <string>

#include "common/calibration/camera_imu_calibration.h"

namespace evit::calibration {

/// The rig with what was found in it.
Rig Calibrated(const Rig& before, const CameraImuCalibration& calibration);

/// A table for a person: each value before and after, its standard deviation, and what was not observable.
std::string CalibrationText(const Rig& before, const CameraImuCalibration& calibration);

/// Comment of the new rig file: where its figures come from. `sources`: one line, e.g. the files.
std::string RigComment(const Rig& before, const CameraImuCalibration& calibration,
                       const std::string& sources);

/// Where the map leans by more than its uncertainty (99.7 %) and 0.05 deg: how to turn it, and where the
/// start pose goes by that; else empty.
std::string TiltAdvice(const CameraImuCalibration& calibration, const std::string& map, const SE3& start);

}  // namespace evit::calibration
