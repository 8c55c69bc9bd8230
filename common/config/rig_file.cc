#include "common/config/rig_file.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "common/config/config_error.h"
#include "common/config/field_rules.h"
#include "common/config/kalibr_file.h"
#include "common/config/rig.pb.h"
#include "common/config/text_file.h"
#include "common/files/whole_file.h"
#include "common/geometry/degrees.h"

namespace evit {
namespace {

// A rig file's message, and where its values stand.
struct RigText {
  explicit RigText(const std::string& file, bool partial = false)
      : path(file),
        settings(partial ? ParsePartialTextFile(file, &message) : ParseTextFile(file, &message)) {}

  // Throws ConfigError about the value of `field`.
  void Require(bool condition, const std::string& field, const std::string& what) const {
    if (condition) return;
    const auto found =
        std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.path == field; });
    throw ConfigError((found == settings.end() ? path : found->Place()) + ": " + field + ": " + what);
  }

  std::string path;
  config::Rig message;
  std::vector<Setting> settings;
};

SE3 ToSE3(const RigText& rig, const config::Transform& t, const std::string& name) {
  const std::string field = name + ".m";
  rig.Require(t.m_size() == 16, field,
              "16 numbers are expected (4x4, row-major), got " + std::to_string(t.m_size()));
  const Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(t.m().data());
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  rig.Require(
      (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 && std::abs(R.determinant() - 1) < 1e-3,
      field, "the upper left 3x3 is not a rotation (rows of length 1, at right angles, right-handed)");
  rig.Require((m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-9, field,
              "the last row must be 0 0 0 1");
  return SE3(m);
}

// Zero where there are no numbers.
Eigen::Vector3d ToSigma(const RigText& rig, const google::protobuf::RepeatedField<double>& numbers,
                        const std::string& name) {
  if (numbers.empty()) return Eigen::Vector3d::Zero();
  rig.Require(numbers.size() == 3, "T_body_camera_sigma." + name,
              "3 numbers are expected (x, y, z), got " + std::to_string(numbers.size()));
  return Eigen::Map<const Eigen::Vector3d>(numbers.data());
}

ExtrinsicsSigma ToExtrinsicsSigma(const RigText& rig) {
  const config::TransformSigma& sigma = rig.message.t_body_camera_sigma();
  return {ToSigma(rig, sigma.rotation_deg(), "rotation_deg") / kDegreesPerRadian,
          ToSigma(rig, sigma.translation_m(), "translation_m")};
}

// As of an Azure Kinect, or of OpenCV's CALIB_RATIONAL_MODEL.
constexpr char kNoRational[] =
    "rational distortion (k1 to k6) is not supported; calibrate with \"plumb_bob\" or \"equidistant\", or "
    "undistort the "
    "pictures (OpenCV's undistort) and give the intrinsics of the undistorted ones with distortion: [0, 0, "
    "0, 0]";

Camera ToCamera(const RigText& rig) {
  const config::Camera& c = rig.message.camera();
  Camera camera;
  rig.Require(c.model().rfind("rational", 0) != 0, "camera.model", kNoRational);
  rig.Require(CameraModelFromName(c.model(), &camera.model), "camera.model",
              "\"" + c.model() + "\" is not known; use \"plumb_bob\" or \"equidistant\"");
  rig.Require(camera.model != Camera::Model::kPlumbBob || c.distortion_size() <= 5, "camera.model",
              kNoRational);
  const double offset = c.time_offset_us();
  rig.Require(offset == 0 || std::abs(offset) >= 1, "camera.time_offset_us",
              NumberText(offset) + " us looks like seconds (Kalibr's timeshift_cam_imu): write " +
                  NumberText(std::round(1e6 * offset)));
  rig.Require(std::abs(offset) <= 1e6, "camera.time_offset_us", "is more than a second");
  rig.Require(c.cx() <= c.width(), "camera.cx", "must lie in the image (pixels, not normalised)");
  rig.Require(c.cy() <= c.height(), "camera.cy", "must lie in the image (pixels, not normalised)");
  rig.Require(c.distortion_size() == 4 || c.distortion_size() == 5, "camera.distortion",
              "4 or 5 numbers are expected, got " + std::to_string(c.distortion_size()));
  camera.width = c.width();
  camera.height = c.height();
  camera.fx = c.fx();
  camera.fy = c.fy();
  camera.cx = c.cx();
  camera.cy = c.cy();
  std::copy(c.distortion().begin(), c.distortion().end(), camera.distortion.begin());
  return camera;
}

ImuNoise ToImuNoise(const config::Imu& imu) {
  ImuNoise noise{imu.gyro_noise_density(), imu.accel_noise_density(), imu.gyro_random_walk(),
                 imu.accel_random_walk()};
  if (imu.has_gyro_range()) noise.gyro_range = imu.gyro_range();
  if (imu.has_accel_range()) noise.accel_range = imu.accel_range();
  return noise;
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
    for (int column = 0; column < 4; ++column) out += (column > 0 ? ", " : "") + NumberText(m(row, column));
    out += "]\n";
  }
  return out + "}\n";
}

std::string NumbersText(const Eigen::Vector3d& v) {
  return "[" + NumberText(v.x()) + ", " + NumberText(v.y()) + ", " + NumberText(v.z()) + "]";
}

// Nothing where it is known exactly.
std::string SigmaText(const ExtrinsicsSigma& sigma) {
  if (sigma.rotation.isZero(0) && sigma.translation.isZero(0)) return "";
  return "\n# Standard deviations of T_body_camera.\nT_body_camera_sigma {\n  rotation_deg: " +
         NumbersText(kDegreesPerRadian * sigma.rotation) +
         "  # about the camera's axes\n  translation_m: " + NumbersText(sigma.translation) +
         "  # along the body's axes\n}\n";
}

std::string MarkerText(const SE3& T_marker_body) {
  return "# Body to the frame that the ground truth describes, row-major 4x4.\n" +
         TransformText("T_marker_body", T_marker_body);
}

std::string CommentText(const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  return text;
}

std::string CameraText(const Camera& c, Utime time_offset) {
  const bool plumb_bob = c.model == Camera::Model::kPlumbBob;
  std::string distortion;
  for (int k = 0; k < (plumb_bob ? 5 : 4); ++k)
    distortion += (k > 0 ? ", " : "") + NumberText(c.distortion[k]);
  return std::string("camera {\n  model: ") + Quoted(CameraModelName(c.model)) +
         "\n  width: " + std::to_string(c.width) + "  # pixels\n  height: " + std::to_string(c.height) +
         "  # pixels\n  fx: " + NumberText(c.fx) + "  # pixels\n  fy: " + NumberText(c.fy) +
         "  # pixels\n  cx: " + NumberText(c.cx) + "  # pixels\n  cy: " + NumberText(c.cy) +
         "  # pixels\n  distortion: [" + distortion + "]  # " +
         (plumb_bob ? "k1 k2 p1 p2 k3" : "k1 k2 k3 k4") +
         "\n  time_offset_us: " + std::to_string(time_offset) +
         "  # us to add to event stamps to get IMU time\n}\n";
}

std::string ImuText(double rate_hz, const ImuNoise& n) {
  // A limit that is not set has no key.
  const std::string ranges =
      (std::isfinite(n.gyro_range) ? "\n  gyro_range: " + NumberText(n.gyro_range) + "  # rad/s, full scale"
                                   : "") +
      (std::isfinite(n.accel_range) ? "\n  accel_range: " + NumberText(n.accel_range) + "  # m/s^2" : "");
  return "imu {\n  rate_hz: " + NumberText(rate_hz) +
         "\n  gyro_noise_density: " + NumberText(n.gyro_density) + "  # rad/s/sqrt(Hz)" +
         "\n  accel_noise_density: " + NumberText(n.accel_density) + "  # m/s^2/sqrt(Hz)" +
         "\n  gyro_random_walk: " + NumberText(n.gyro_random_walk) + "  # rad/s^2/sqrt(Hz)" +
         "\n  accel_random_walk: " + NumberText(n.accel_random_walk) + "  # m/s^3/sqrt(Hz)" + ranges +
         "\n}\n";
}

}  // namespace

Rig LoadRig(const std::string& path) {
  if (IsKalibr(path)) return LoadKalibrRig(path);
  const RigText text(path);
  const config::Rig& message = text.message;
  Rig rig;
  rig.camera = ToCamera(text);
  rig.camera_time_offset = std::llround(message.camera().time_offset_us());
  rig.T_body_camera = ToSE3(text, message.t_body_camera(), "T_body_camera");
  rig.T_body_camera_sigma = ToExtrinsicsSigma(text);
  if (message.has_t_marker_body()) rig.T_marker_body = ToSE3(text, message.t_marker_body(), "T_marker_body");
  rig.imu_rate_hz = message.imu().rate_hz();
  rig.imu_noise = ToImuNoise(message.imu());
  rig.gravity = message.gravity();
  return rig;
}

MountedCamera LoadMountedCamera(const std::string& path) {
  const RigText text(path, true);
  text.Require(text.message.has_camera(), "camera",
               "this block is missing; see the commented files in config/");
  std::vector<std::string> missing;
  text.message.camera().FindInitializationErrors(&missing);
  for (const std::string& field : missing)
    text.Require(field == "time_offset_us", "camera." + field, "this key is missing");
  const config::Rig& message = text.message;
  MountedCamera mounted;
  mounted.camera = ToCamera(text);
  mounted.time_offset = std::llround(message.camera().time_offset_us());
  mounted.mounted = message.has_t_body_camera();
  if (mounted.mounted) mounted.T_body_camera = ToSE3(text, message.t_body_camera(), "T_body_camera");
  if (message.has_t_marker_body())
    mounted.T_marker_body = ToSE3(text, message.t_marker_body(), "T_marker_body");
  return mounted;
}

void WriteMountedCamera(const std::string& path, const MountedCamera& camera, const std::string& comment) {
  WholeFile file(path);
  file.stream() << CommentText(comment) << CameraText(camera.camera, camera.time_offset)
                << "\n# Camera to body (= IMU), row-major 4x4.\n"
                << TransformText("T_body_camera", camera.T_body_camera) << '\n'
                << MarkerText(camera.T_marker_body);
  file.Commit();
}

std::string LoadRigName(const std::string& path) {
  return IsKalibr(path) ? KalibrRigName(path) : RigText(path).message.name();
}

void WriteRig(const std::string& path, const Rig& rig, const std::string& name, const std::string& comment) {
  std::ostringstream text;
  text << CommentText(comment) << "name: " << Quoted(name) << "\n\n"
       << CameraText(rig.camera, rig.camera_time_offset) << '\n'
       << ImuText(rig.imu_rate_hz, rig.imu_noise) << "\n# Event camera to body (= IMU), row-major 4x4.\n"
       << TransformText("T_body_camera", rig.T_body_camera) << SigmaText(rig.T_body_camera_sigma) << '\n'
       << MarkerText(rig.T_marker_body) << "\ngravity: " << NumberText(rig.gravity)
       << "  # m/s^2, along -z of the map frame\n";
  WholeFile file(path);
  file.stream() << text.str();
  file.Commit();
}

}  // namespace evit
