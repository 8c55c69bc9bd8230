#include "tools/formats/calibration_files/basalt_calibration.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace evit::formats {
namespace {

using nlohmann::json;

void ReadIntrinsics(const json& camera, Camera* out) {
  const std::string type = camera.at("camera_type");
  const json& values = camera.at("intrinsics");
  out->fx = values.at("fx");
  out->fy = values.at("fy");
  out->cx = values.at("cx");
  out->cy = values.at("cy");
  if (type == "kb4") {
    out->model = Camera::Model::kEquidistant;
    out->distortion = {values.at("k1"), values.at("k2"), values.at("k3"), values.at("k4"), 0};
  } else if (type == "pinhole-radtan8") {
    for (const char* rational : {"k4", "k5", "k6"}) {
      if (values.at(rational).get<double>() != 0)
        throw std::runtime_error("the camera has rational distortion (k4, k5, k6), which is not supported");
    }
    out->distortion = {values.at("k1"), values.at("k2"), values.at("p1"), values.at("p2"), values.at("k3")};
  } else {
    throw std::runtime_error("camera_type " + type + " is not supported; expected kb4 or pinhole-radtan8");
  }
}

double Mean(const json& three) {
  return (three.at(0).get<double>() + three.at(1).get<double>() + three.at(2).get<double>()) / 3;
}

SE3 Pose(const json& T, const std::string& name) {
  const Eigen::Quaterniond q(T.at("qw").get<double>(), T.at("qx").get<double>(), T.at("qy").get<double>(),
                             T.at("qz").get<double>());
  if (!(std::abs(q.norm() - 1) < 1e-3)) throw std::runtime_error(name + "'s quaternion is not a rotation");
  return {q.normalized(), {T.at("px").get<double>(), T.at("py").get<double>(), T.at("pz").get<double>()}};
}

Rig Convert(const json& calibration, int width, int height) {
  Rig rig;
  const json& sizes = calibration.at("resolution");
  std::size_t k = 0;
  std::string list;
  for (; k < sizes.size() && (sizes[k].at(0) != width || sizes[k].at(1) != height); ++k)
    list += (list.empty() ? "" : ", ") + std::to_string(sizes[k].at(0).get<int>()) + "x" +
            std::to_string(sizes[k].at(1).get<int>());
  if (k == sizes.size())
    throw std::runtime_error("none of its cameras has " + std::to_string(width) + "x" +
                             std::to_string(height) + " pixels, but " + list);
  ReadIntrinsics(calibration.at("intrinsics").at(k), &rig.camera);
  rig.camera.width = width;
  rig.camera.height = height;
  rig.T_body_camera = Pose(calibration.at("T_imu_cam").at(k), "T_imu_cam");
  rig.imu_rate_hz = calibration.at("imu_update_rate");
  rig.imu_noise.gyro_density = Mean(calibration.at("gyro_noise_std"));
  rig.imu_noise.accel_density = Mean(calibration.at("accel_noise_std"));
  rig.imu_noise.gyro_random_walk = Mean(calibration.at("gyro_bias_std"));
  rig.imu_noise.accel_random_walk = Mean(calibration.at("accel_bias_std"));
  rig.camera_time_offset = std::llround(1e-3 * calibration.value("cam_time_offset_ns", 0.0));
  return rig;
}

// What `read` makes of the file's value.
template <typename Read>
auto WithValue(const std::string& path, const Read& read) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read; is the path right?");
  try {
    const json whole = json::parse(file);
    return read(whole.contains("value0") ? whole.at("value0") : whole);
  } catch (const std::exception& error) {
    throw std::runtime_error(path +
                             ": is not a calibration that can be read (Basalt's JSON): " + error.what());
  }
}

}  // namespace

Rig ReadBasaltCalibration(const std::string& path, int width, int height) {
  return WithValue(path, [&](const json& value) { return Convert(value, width, height); });
}

std::optional<SE3> ReadBasaltMarker(const std::string& path) {
  return WithValue(path, [&](const json& value) -> std::optional<SE3> {
    if (!value.contains("T_imu_marker")) return std::nullopt;
    return Pose(value.at("T_imu_marker"), "T_imu_marker");
  });
}

bool HasBasaltCameras(const std::string& path) {
  return WithValue(path, [&](const json& value) { return value.contains("intrinsics"); });
}

}  // namespace evit::formats
