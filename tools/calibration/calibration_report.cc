#include "tools/calibration/calibration_report.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "common/calibration/calibrated_sigma.h"
#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::calibration {
namespace {

constexpr double kSureTilt = 11.6, kSmallTilt = 0.05 / kDegreesPerRadian;  // chi-square of 2 dof, 99.7 %; rad
constexpr char kAxes[] = "xyz";

struct Row {
  std::string name;
  double before, after, sigma;
  bool in_rig;
};

std::vector<Row> Rows(const Rig& before, const CameraImuCalibration& c) {
  std::vector<Row> rows;
  rows.reserve(15);
  const auto sigma = [&](int k) { return std::sqrt(c.covariance(k, k)); };
  const Eigen::Vector3d turn =
      kDegreesPerRadian * LogSO3(before.T_body_camera.q.conjugate() * c.values.T_body_camera.q);
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("T_body_camera %c [mm]", kAxes[k]), 1e3 * before.T_body_camera.p[k],
                    1e3 * c.values.T_body_camera.p[k], 1e3 * sigma(k), true});
  }
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("turned about the camera's %c [deg]", kAxes[k]), 0, turn[k],
                    kDegreesPerRadian * sigma(3 + k), true});
  }
  rows.push_back({"camera.time_offset_us [ms]", 1e3 * ToSeconds(before.camera_time_offset),
                  1e3 * ToSeconds(c.values.offset), 1e3 * sigma(6), true});
  for (int k = 0; k < 2; ++k) {
    rows.push_back({FormatText("tilt of the map about its %c [deg]", kAxes[k]), 0,
                    kDegreesPerRadian * c.values.tilt[k], kDegreesPerRadian * sigma(7 + k), false});
  }
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("gyro bias %c [mrad/s]", kAxes[k]), 0, 1e3 * c.values.bias.gyro[k],
                    1e3 * sigma(9 + k), false});
  }
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("accelerometer bias %c [mm/s^2]", kAxes[k]), 0, 1e3 * c.values.bias.accel[k],
                    1e3 * sigma(12 + k), false});
  }
  return rows;
}

std::string Direction(const Unobservable& u, const char* frame) {
  return FormatText("(%.2f, %.2f, %.2f) of the %s", u.direction.x(), u.direction.y(), u.direction.z(), frame);
}

std::string Sentence(const Unobservable& u) {
  constexpr char kTurn[] = "turn faster, and about at least two axes";
  constexpr char kKept[] = "the value of the rig file is kept";
  using Value = Unobservable::Value;
  switch (u.value) {
    case Value::kTranslation:
      return "translation along " + Direction(u, "body") +
             FormatText(", known to %.1f cm only: %s; %s", 100 * u.sigma, kKept, kTurn);
    case Value::kRotation:
      return "rotation about " + Direction(u, "camera") +
             FormatText(", known to %.1f deg only: %s; %s", kDegreesPerRadian * u.sigma, kKept, kTurn);
    case Value::kTimeOffset:
      return FormatText("time offset, known to %.1f ms only: %s; turn faster", 1e3 * u.sigma, kKept);
    case Value::kGyroBias:
      return "gyro bias along " + Direction(u, "body") +
             FormatText(", known to %.0f mrad/s only; record for longer", 1e3 * u.sigma);
    case Value::kAccelBias:
      return "accelerometer bias along " + Direction(u, "body") +
             FormatText(", known to %.0f mm/s^2 only; tilt the rig this way and that", 1e3 * u.sigma);
    case Value::kTilt:
      break;
  }
  return "tilt of the map about " + Direction(u, "map") +
         FormatText(", known to %.1f deg only; tilt the rig this way and that", kDegreesPerRadian * u.sigma);
}

}  // namespace

Rig Calibrated(const Rig& before, const CameraImuCalibration& c) {
  Rig rig = before;
  rig.T_body_camera = c.values.T_body_camera;
  rig.T_body_camera_sigma =
      CalibratedSigma(c.covariance.topLeftCorner<6, 6>(), c.unobservable, before.T_body_camera_sigma);
  rig.camera_time_offset = c.values.offset;
  return rig;
}

std::string CalibrationText(const Rig& before, const CameraImuCalibration& c) {
  std::string text =
      FormatText("%.1f s, %d poses of the camera, %d left out; turning %.2f, %.2f, %.2f rad/s by axis\n",
                 c.seconds, c.n_poses, c.n_rejected, c.turning[0], c.turning[1], c.turning[2]);
  text += FormatText("poses fit the IMU to %.1f mm and %.2f deg, alike for %.0f and %.0f poses\n\n",
                     1e3 * c.noise.position, kDegreesPerRadian * c.noise.rotation,
                     c.noise.position_correlation, c.noise.rotation_correlation);
  text += FormatText("%-34s %10s %12s %10s\n", "", "rig file", "calibrated", "sigma");
  for (const Row& row : Rows(before, c)) {
    text += FormatText("%-34s %10s %12.3f %10.3f\n", row.name.c_str(),
                       row.in_rig ? FormatText("%.3f", row.before).c_str() : "-", row.after, row.sigma);
  }
  const Eigen::Vector3d moved = c.values.T_body_camera.p - before.T_body_camera.p;
  text += FormatText("camera turned by %.2f deg and moved by %.1f mm\n",
                     kDegreesPerRadian * AngularDistance(before.T_body_camera.q, c.values.T_body_camera.q),
                     1e3 * moved.norm());
  for (const Unobservable& u : c.unobservable)
    text += "NOT OBSERVABLE from this motion: " + Sentence(u) + "\n";
  return text;
}

std::string RigComment(const Rig& before, const CameraImuCalibration& c, const std::string& sources) {
  std::string text =
      "T_body_camera, its standard deviations and camera.time_offset_us by evit calibrate; all other values "
      "are unchanged.\n" +
      sources + "\n";
  for (const Row& row : Rows(before, c)) {
    if (!row.in_rig) continue;
    text +=
        FormatText("  %s: %.3f, was %.3f, sigma %.3f\n", row.name.c_str(), row.after, row.before, row.sigma);
  }
  for (const Unobservable& u : c.unobservable) text += "not observable: " + Sentence(u) + "\n";
  return text;
}

std::string TiltAdvice(const CameraImuCalibration& c, const std::string& map, const SE3& start) {
  const Eigen::Vector2d& tilt = c.values.tilt;
  const Eigen::Matrix2d P = c.covariance.block<2, 2>(7, 7);
  if (tilt.norm() < kSmallTilt || tilt.dot(P.inverse() * tilt) < kSureTilt) return "";
  const SE3 T_upright_map{ExpSO3({-tilt.x(), -tilt.y(), 0}), Eigen::Vector3d::Zero()};
  const Eigen::Matrix3d R = T_upright_map.R();
  std::string numbers;
  for (int r = 0; r < 3; ++r) numbers += FormatText("%.9f %.9f %.9f 0 ", R(r, 0), R(r, 1), R(r, 2));
  const SE3 turned = T_upright_map * start;
  const std::string upright = map.substr(0, map.find_last_of('.')) + "_upright.pcd";
  return FormatText("The map leans by %.2f deg: gravity is not along its -z. Turn it with\n",
                    kDegreesPerRadian * tilt.norm()) +
         "  evit map import " + map + " " + upright + " --transform \"" + numbers + "0 0 0 1\"\n" +
         FormatText(
             "after which this recording starts at --initial-pose \"%.6f %.6f %.6f %.8f %.8f %.8f %.8f\"; "
             "truth "
             "turns by the same matrix (evit import --T-map-world).\n",
             turned.p.x(), turned.p.y(), turned.p.z(), turned.q.x(), turned.q.y(), turned.q.z(),
             turned.q.w());
}

}  // namespace evit::calibration
