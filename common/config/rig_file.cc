#include "common/config/rig_file.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace evit {
namespace {

// The shortest text that reads back as the same number.
std::string Text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// In double quotes, with what protobuf's text format would take for more than a letter escaped.
std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + '"';
}

std::string TransformText(const char* name, const SE3& T) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = T.R();
  m.topRightCorner<3, 1>() = T.p;
  std::string out = std::string(name) + " {\n";
  for (int row = 0; row < 4; ++row) {
    out += "  m: [";
    for (int column = 0; column < 4; ++column) out += (column > 0 ? ", " : "") + Text(m(row, column));
    out += "]\n";
  }
  return out + "}\n";
}

std::string CameraText(const Camera& c, Utime time_offset) {
  const bool plumb_bob = c.model == Camera::Model::kPlumbBob;
  std::string distortion;
  for (int k = 0; k < (plumb_bob ? 5 : 4); ++k) distortion += (k > 0 ? ", " : "") + Text(c.distortion[k]);
  return std::string("camera {\n  model: ") + Quoted(CameraModelName(c.model)) +
         "\n  width: " + std::to_string(c.width) + "  # pixels\n  height: " + std::to_string(c.height) +
         "  # pixels\n  fx: " + Text(c.fx) + "  # pixels\n  fy: " + Text(c.fy) +
         "  # pixels\n  cx: " + Text(c.cx) + "  # pixels\n  cy: " + Text(c.cy) +
         "  # pixels\n  distortion: [" + distortion + "]  # " +
         (plumb_bob ? "k1 k2 p1 p2 k3" : "k1 k2 k3 k4") +
         "\n  time_offset_us: " + std::to_string(time_offset) +
         "  # us to add to event stamps to get IMU time\n}\n";
}

std::string ImuText(double rate_hz, const ImuNoise& n) {
  // No limit is no key.
  const std::string ranges =
      (std::isfinite(n.gyro_range) ? "\n  gyro_range: " + Text(n.gyro_range) + "  # rad/s, full scale" : "") +
      (std::isfinite(n.accel_range) ? "\n  accel_range: " + Text(n.accel_range) + "  # m/s^2" : "");
  return "imu {\n  rate_hz: " + Text(rate_hz) + "\n  gyro_noise_density: " + Text(n.gyro_density) +
         "  # rad/s/sqrt(Hz)" + "\n  accel_noise_density: " + Text(n.accel_density) + "  # m/s^2/sqrt(Hz)" +
         "\n  gyro_random_walk: " + Text(n.gyro_random_walk) + "  # rad/s^2/sqrt(Hz)" +
         "\n  accel_random_walk: " + Text(n.accel_random_walk) + "  # m/s^3/sqrt(Hz)" + ranges + "\n}\n";
}

}  // namespace

void WriteRig(const std::string& path, const Rig& rig, const std::string& name, const std::string& comment) {
  std::ostringstream text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text << "# " << line << '\n';
  text << "name: " << Quoted(name) << "\n\n"
       << CameraText(rig.camera, rig.camera_time_offset) << '\n'
       << ImuText(rig.imu_rate_hz, rig.imu_noise) << "\n# Event camera to body (= IMU), row-major 4x4.\n"
       << TransformText("T_body_camera", rig.T_body_camera)
       << "\n# Body to the frame that the ground truth tells of, row-major 4x4.\n"
       << TransformText("T_marker_body", rig.T_marker_body) << "\ngravity: " << Text(rig.gravity)
       << "  # m/s^2, along -z of the map frame\n";
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  file << text.str();
  file.close();
  if (!file || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw std::runtime_error(path +
                             ": cannot be written; check that the folder exists, is writable and has room");
  }
}

}  // namespace evit
