#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/rig.h"

namespace evit::formats {

/// What a calibration is looked for.
struct CalibrationChoice {
  int width = 0, height = 0;         // of the recording
  std::string side = "left";         // which of two event cameras, where a file has both
  std::optional<SE3> T_body_camera;  // in place of the file's, or where it has none (DSEC)
};

struct FoundCalibration {
  Rig rig;
  std::string source;        // format and file, for people
  bool imu_assumed = false;  // the file has no IMU: its noise is that of a consumer IMU, its rate 0
};

/// A published calibration as a rig, recognised by its contents: Basalt's JSON (TUM-VIE; a second such file
/// with T_imu_marker tells where the truth's body is), M3ED's HDF5, DSEC's cam_to_cam.yaml, Kalibr's
/// camchain-imucam.yaml (MVSEC). Throws std::runtime_error naming the file and what is missing.
FoundCalibration ReadCalibration(const std::vector<std::string>& paths, const CalibrationChoice& choice);

}  // namespace evit::formats
