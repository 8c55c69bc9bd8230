#pragma once

#include <functional>
#include <string>

#include "common/geometry/rig.h"
#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// The MPU6150 in a DAVIS240C. Densities: its data sheet (0.005 deg/s/sqrt(Hz), 400 ug/sqrt(Hz)). Random
/// walks: no sheet gives them; these are usual for IMUs of its class.
inline constexpr ImuNoise kDavisImuNoise{8.73e-5, 3.92e-3, 4.0e-6, 2.0e-4};

/// A folder in the text format of RPG's event camera dataset (https://rpg.ifi.uzh.ch/davis_data.html), to
/// become an LCM log.
struct RpgImport : ImportTarget {
  std::string folder;             // holds events.txt, imu.txt and, where known, groundtruth.txt and calib.txt
  std::string rig_out;            // rig file to make of calib.txt; none where empty
  int width = 240, height = 180;  // pixels; DAVIS240
  SE3 T_body_camera;
  bool truth_of_body =
      false;  // groundtruth.txt tells of the body (IMU); else, as in the dataset, of the camera
  ImuNoise imu_noise = kDavisImuNoise;
};

/// As ImportLog. Events, samples and poses that are out of order, not finite or outside the sensor are
/// counted and left out.
ImportSummary ImportRpg(const RpgImport& job, const std::function<void(double)>& progress);

}  // namespace evit::formats
