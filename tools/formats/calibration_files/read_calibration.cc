#include "tools/formats/calibration_files/read_calibration.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "common/config/kalibr_file.h"
#include "tools/formats/calibration_files/basalt_calibration.h"
#include "tools/formats/calibration_files/dsec_calibration.h"
#include "tools/formats/calibration_files/m3ed_calibration.h"
#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {
namespace {

bool IsJson(const std::string& path) {
  std::ifstream file(path);
  char first = 0;
  return file >> first && first == '{';
}

FoundCalibration ReadOne(const std::string& path, const CalibrationChoice& choice) {
  FoundCalibration found;
  // Kalibr's CHAIN#CAMERA,IMU has no existing path.
  const std::string file = path.substr(0, path.find_first_of(",#"));
  if (!std::filesystem::is_regular_file(file)) throw std::runtime_error(file + ": there is no such file");
  if (H5File::Recognises(file)) {
    found.source = "M3ED's " + file + ", " + choice.side + " event camera; IMU noise: VN-100";
    found.rig = ReadM3edCalibration(file, choice.side);
  } else if (IsJson(file)) {
    found.source = "Basalt's " + file;
    found.rig = ReadBasaltCalibration(file, choice.width, choice.height);
  } else if (IsDsecCalibration(file)) {
    found.source = "DSEC's " + file + ", " + choice.side + " event camera";
    found.rig = ReadDsecCalibration(file, choice.side);
    found.imu_assumed = true;
    if (!choice.T_body_camera)
      throw std::runtime_error(file +
                               ": says nothing of an IMU; give where the camera is in its frame with "
                               "--t-body-camera \"x y z qx qy qz qw\"");
  } else {
    found.source = KalibrRigName(path);
    found.rig = LoadKalibrRig(path);
    found.imu_assumed = found.rig.imu_noise.gyro_density == kConsumerImuNoise.gyro_density;
  }
  return found;
}

}  // namespace

FoundCalibration ReadCalibration(const std::vector<std::string>& paths, const CalibrationChoice& choice) {
  std::optional<SE3> T_imu_marker;
  std::vector<std::string> cameras;
  for (const std::string& path : paths) {
    const std::optional<SE3> marker = IsJson(path) ? ReadBasaltMarker(path) : std::nullopt;
    if (marker) T_imu_marker = marker;
    if (!marker || HasBasaltCameras(path)) cameras.push_back(path);
  }
  if (cameras.size() != 1)
    throw std::runtime_error(paths.front() + ": expected one calibration with cameras, got " +
                             std::to_string(cameras.size()));
  FoundCalibration found = ReadOne(cameras.front(), choice);
  if (T_imu_marker) found.rig.T_marker_body = T_imu_marker->Inverse();
  if (choice.T_body_camera) found.rig.T_body_camera = *choice.T_body_camera;
  if (found.imu_assumed) {
    found.rig.imu_noise = kConsumerImuNoise;
    found.rig.imu_rate_hz = 0;
  }
  if (found.rig.camera.width != choice.width || found.rig.camera.height != choice.height) {
    throw std::runtime_error(cameras.front() + ": is of a camera of " +
                             std::to_string(found.rig.camera.width) + "x" +
                             std::to_string(found.rig.camera.height) + " pixels, the recording of one of " +
                             std::to_string(choice.width) + "x" + std::to_string(choice.height) +
                             "; give --size where the recording does not say it");
  }
  return found;
}

}  // namespace evit::formats
