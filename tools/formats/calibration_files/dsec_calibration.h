#pragma once

#include <string>

#include "common/geometry/rig.h"

namespace evit::formats {

/// The event camera of DSEC's cam_to_cam.yaml: `side` "left" (cam0) or "right" (cam3), as recorded (not
/// rectified). Only Rig::camera is filled: the file says nothing of an IMU. Throws std::runtime_error naming
/// file and key.
Rig ReadDsecCalibration(const std::string& path, const std::string& side);

/// Whether a file of YAML is one: it has intrinsics.cam0 with a camera_matrix.
bool IsDsecCalibration(const std::string& path);

}  // namespace evit::formats
