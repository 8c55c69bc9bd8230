#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/geometry/rig.h"

namespace evit {

/// Whether a rig is given as Kalibr's files: "camchain-imucam.yaml", or with a camera and an IMU file chosen,
/// "camchain-imucam.yaml#cam1,imu.yaml".
bool IsKalibr(const std::string& path);

/// Kalibr's camchain-imucam.yaml with the IMU's noise of imu.yaml (given behind a comma, else the file of
/// that name beside it: X-camchain-imucam.yaml and X-imu.yaml, or imu.yaml). T_cam_imu is inverted,
/// timeshift_cam_imu becomes microseconds. Without an IMU file the noise is that of a consumer IMU
/// (kConsumerImuNoise), 200 Hz. Throws ConfigError naming file, key and remedy.
Rig LoadKalibrRig(const std::string& path);

/// Where the rig's figures come from, for people.
std::string KalibrRigName(const std::string& path);

/// Densities and walks of IMUs in phones and cheap cameras, somewhat inflated as Kalibr advises.
inline constexpr ImuNoise kConsumerImuNoise{1e-3, 1e-2, 2e-5, 3e-4};

/// The part of YAML that Kalibr writes: nested maps by indentation, numbers, words and lists of these. Each
/// value is kept under its path ("cam0.T_cam_imu") as its words, lists flattened. Throws ConfigError naming
/// `path` and line.
std::map<std::string, std::vector<std::string>> ParseSimpleYaml(const std::string& text,
                                                                const std::string& path);

}  // namespace evit
