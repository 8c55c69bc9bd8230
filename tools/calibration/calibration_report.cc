#include "tools/calibration/calibration_report.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::calibration {
namespace {

constexpr double kSureTilt = 11.6, kSmallTilt = 0.05 / kDegreesPerRadian;  // chi-square of 2 dof, 99.7 %; rad
constexpr double kContradiction = 4;  // of seven sigmas: 2.6 are to be expected
constexpr char kAxes[] = "xyz";

struct Row {
  std::string name;
  double before, after, sigma;
  double prior = 0;  // sigma before; 0: no value of the rig file
};

// How much of a value the recording gave, by its variance before and after.
const char* Learned(const Row& row) {
  const double left = std::pow(row.sigma / row.prior, 2);
  return left < 0.25 ? "learned" : left < 0.75 ? "partly learned" : "kept";
}

std::vector<Row> Rows(const Rig& before, const CameraImuCalibration& c) {
  std::vector<Row> rows;
  rows.reserve(15);
  const auto sigma = [&](int k) { return std::sqrt(c.covariance(k, k)); };
  const Eigen::Vector3d turn =
      kDegreesPerRadian * LogSO3(before.T_body_camera.q.conjugate() * c.values.T_body_camera.q);
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("T_body_camera %c [mm]", kAxes[k]), 1e3 * before.T_body_camera.p[k],
                    1e3 * c.values.T_body_camera.p[k], 1e3 * sigma(k), 1e3 * c.prior_sigma[k]});
  }
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("turned about the camera's %c [deg]", kAxes[k]), 0, turn[k],
                    kDegreesPerRadian * sigma(3 + k), kDegreesPerRadian * c.prior_sigma[3 + k]});
  }
  rows.push_back({"camera.time_offset_us [ms]", 1e3 * ToSeconds(before.camera_time_offset),
                  1e3 * ToSeconds(c.values.offset), 1e3 * sigma(6), 1e3 * c.prior_sigma[6]});
  for (int k = 0; k < 2; ++k) {
    rows.push_back({FormatText("tilt of the map about its %c [deg]", kAxes[k]), 0,
                    kDegreesPerRadian * c.values.tilt[k], kDegreesPerRadian * sigma(7 + k)});
  }
  for (int k = 0; k < 3; ++k) {
    rows.push_back(
        {FormatText("gyro bias %c [mrad/s]", kAxes[k]), 0, 1e3 * c.values.bias.gyro[k], 1e3 * sigma(9 + k)});
  }
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("accelerometer bias %c [mm/s^2]", kAxes[k]), 0, 1e3 * c.values.bias.accel[k],
                    1e3 * sigma(12 + k)});
  }
  return rows;
}

std::string Along(const Eigen::Vector3d& v, const char* frame) {
  const Eigen::Vector3d d = v.normalized();
  return FormatText("(%.2f, %.2f, %.2f) of the %s", d.x(), d.y(), d.z(), frame);
}

// What varies along a direction: parts that are more than a tenth of it.
std::string Name(const RigDirection& d, const RigVector& prior_sigma) {
  constexpr double kPart = 0.1;
  const RigVector parts = d.one_sigma.cwiseQuotient(prior_sigma).cwiseAbs2();
  std::string name;
  const auto add = [&](double part, const std::string& what) {
    if (part > kPart) name += (name.empty() ? "" : " with ") + what;
  };
  add(parts.head<3>().sum(), "translation along " + Along(d.one_sigma.head<3>(), "body"));
  add(parts.segment<3>(3).sum(), "rotation about " + Along(d.one_sigma.segment<3>(3), "camera"));
  add(parts[6], "time offset");
  return name;
}

std::string DirectionText(const CameraImuCalibration& c) {
  std::string text;
  bool all = true;
  for (const RigDirection& d : c.rig.directions) {
    const std::string name = Name(d, c.prior_sigma);
    const double sigma = std::sqrt(d.posterior_variance);
    all = all && d.observable;
    if (!d.observable) {
      text += "not observable from this motion, kept: " + name + FormatText(", known to %.2f", sigma);
    } else {
      text += (d.moved ? "learned, moved: " : "may be right, kept: ") + name +
              FormatText(", off by %.2f +- %.2f", std::abs(d.posterior_mean), sigma);
    }
    text += " of the rig file's sigma\n";
  }
  if (all) return text;
  return text + "To learn more, turn faster and about at least two axes.\n";
}

// Where the rig file is wrong by much more than it says, its figures pull at the result.
std::string Contradiction(const CameraImuCalibration& c) {
  const double off = c.rig.change.cwiseQuotient(c.prior_sigma).norm();
  if (off < kContradiction) return "";
  return FormatText(
      "note: the rig file is off by %.1f of its sigmas, which draws the result towards it: state larger "
      "ones in T_body_camera_sigma, or calibrate again from the new rig file with these\n",
      off);
}

std::string Sentence(const Unobservable& u) {
  if (u.value == Unobservable::Value::kGyroBias) {
    return "gyro bias along " + Along(u.direction, "body") +
           FormatText(", known to %.0f mrad/s only; record for longer", 1e3 * u.sigma);
  }
  constexpr char kLean[] = "only; tilt the rig this way and that";
  if (u.value == Unobservable::Value::kAccelBias) {
    return "accelerometer bias along " + Along(u.direction, "body") +
           FormatText(", known to %.0f mm/s^2 %s", 1e3 * u.sigma, kLean);
  }
  return "tilt of the map about " + Along(u.direction, "map") +
         FormatText(", known to %.1f deg %s", kDegreesPerRadian * u.sigma, kLean);
}

}  // namespace

Rig Calibrated(const Rig& before, const CameraImuCalibration& c) {
  if (!c.rig.learned_any()) return before;
  Rig rig = before;
  rig.T_body_camera = c.values.T_body_camera;
  const RigVector sigma = c.rig.covariance.diagonal().cwiseSqrt();
  rig.T_body_camera_sigma = {sigma.segment<3>(3), sigma.head<3>()};
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
  text += FormatText("%-34s %10s %8s %12s %8s\n", "", "rig file", "+-", "calibrated", "+-");
  for (const Row& row : Rows(before, c)) {
    if (row.prior > 0) {
      text += FormatText("%-34s %10.3f %8.3f %12.3f %8.3f  %s\n", row.name.c_str(), row.before, row.prior,
                         row.after, row.sigma, Learned(row));
    } else {
      text += FormatText("%-34s %10s %8s %12.3f %8.3f\n", row.name.c_str(), "-", "-", row.after, row.sigma);
    }
  }
  const Eigen::Vector3d moved = c.values.T_body_camera.p - before.T_body_camera.p;
  text += FormatText("camera turned by %.2f deg and moved by %.1f mm\n",
                     kDegreesPerRadian * AngularDistance(before.T_body_camera.q, c.values.T_body_camera.q),
                     1e3 * moved.norm());
  text += DirectionText(c) + Contradiction(c);
  for (const Unobservable& u : c.unobservable) text += "not observable: " + Sentence(u) + "\n";
  return text;
}

std::string RigComment(const Rig& before, const CameraImuCalibration& c, const std::string& sources) {
  std::string text =
      "T_body_camera, its standard deviations and camera.time_offset_us by evit calibrate; all other values "
      "are unchanged.\n" +
      sources + "\n";
  for (const Row& row : Rows(before, c)) {
    if (row.prior == 0) continue;
    text += FormatText("  %s: %.3f, was %.3f, sigma %.3f, was %.3f: %s\n", row.name.c_str(), row.after,
                       row.before, row.sigma, row.prior, Learned(row));
  }
  return text + DirectionText(c);
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
