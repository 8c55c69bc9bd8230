#include "common/imu/imu_plausibility.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/geometry/degrees.h"
#include "common/geometry/so3.h"
#include "common/imu/standard_gravity.h"

namespace evit {
namespace {

constexpr std::size_t kMinSamples = 20;
constexpr Utime kWindow = 500'000, kMinSpan = 200'000;  // us

// Half a second of samples.
struct Window {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();  // means
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();  // body at the end in body at the begin, rad/s
  Eigen::Matrix3d turned_degrees = Eigen::Matrix3d::Identity();  // the same if the gyro says deg/s
};

std::vector<Window> Windows(const std::vector<ImuSample>& samples) {
  std::vector<Window> windows;
  const Utime span = samples.back().t - samples.front().t;
  const Utime length = std::min(kWindow, std::max<Utime>(span / 2, 1));
  std::size_t k = 0;
  while (k < samples.size()) {
    Window w;
    const std::size_t begin = k;
    for (; k < samples.size() && samples[k].t - samples[begin].t < length; ++k) {
      w.force += samples[k].accel;
      w.rate += samples[k].gyro;
      const double dt = k > begin ? std::min(0.1, ToSeconds(samples[k].t - samples[k - 1].t)) : 0;
      w.turned *= ExpSO3(dt * samples[k].gyro).toRotationMatrix();
      w.turned_degrees *= ExpSO3(kRadiansPerDegree * dt * samples[k].gyro).toRotationMatrix();
    }
    const auto n = static_cast<double>(k - begin);
    w.force /= n;
    w.rate /= n;
    if (n >= 3) windows.push_back(w);
  }
  return windows;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How far, in rad (median), gravity's direction in one window is from where the rotation brings that of the
// window before. The middle of one to the middle of the next: half of each window's turn.
double DirectionError(const std::vector<Window>& windows, Eigen::Matrix3d Window::*turned) {
  const auto half = [](const Eigen::Matrix3d& R) {
    return ExpSO3(0.5 * LogSO3(Eigen::Quaterniond(R).normalized())).toRotationMatrix();
  };
  std::vector<double> errors;
  for (std::size_t k = 1; k < windows.size(); ++k) {
    const Eigen::Matrix3d R = half(windows[k - 1].*turned) * half(windows[k].*turned);
    const Eigen::Vector3d predicted = R.transpose() * windows[k - 1].force;
    errors.push_back(std::atan2(predicted.cross(windows[k].force).norm(), predicted.dot(windows[k].force)));
  }
  return errors.empty() ? 0 : Median(errors);
}

std::string Sentence(const char* format, double value) {
  char text[300];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

std::string ImuComplaint(const std::vector<ImuSample>& samples) {
  if (samples.size() < kMinSamples || samples.back().t - samples.front().t < kMinSpan) return "";
  const std::vector<Window> windows = Windows(samples);
  if (windows.empty()) return "";
  std::vector<double> forces, rates, speeds;
  for (const Window& w : windows) forces.push_back(w.force.norm()), rates.push_back(w.rate.norm());
  for (const ImuSample& s : samples) speeds.push_back(s.gyro.norm());
  const double force = Median(forces), rate = Median(rates), speed = Median(speeds);
  const auto is = [](double value, double expected) {
    return value > 0.8 * expected && value < 1.25 * expected;
  };
  if (force < 0.5 * kStandardGravity && is(rate, kStandardGravity)) {
    return Sentence(
        "gyro and accelerometer seem to be swapped: the gyro's mean has length %.2f, as gravity has; name "
        "the columns in the file's first line, "
        "e.g. t gx gy gz ax ay az",
        rate);
  }
  // Gravity is much the same in every window; what is left without it is not.
  const auto near = std::count_if(forces.begin(), forces.end(), [&](double f) { return is(f, 1); });
  if (is(force, 1) && 4 * static_cast<std::size_t>(near) >= 3 * forces.size()) {
    return Sentence(
        "the accelerometer seems to be in g: its mean has length %.3f where gravity has 9.81 m/s^2", force);
  }
  if (is(force, 1000)) {
    return Sentence(
        "the accelerometer seems to be in mg or cm/s^2: its mean has length %.0f where gravity has 9.81 "
        "m/s^2",
        force);
  }
  if (force < 0.6 * kStandardGravity) {
    return Sentence(
        "gravity seems to have been taken off the accelerometer: its mean has length %.2f m/s^2, expected "
        "some 9.81; "
        "record the raw specific force",
        force);
  }
  if (force > 2.5 * kStandardGravity) {
    return Sentence("the accelerometer is not in m/s^2: its mean has length %.1f where gravity has 9.81",
                    force);
  }
  const double as_radians = DirectionError(windows, &Window::turned);
  const double as_degrees = DirectionError(windows, &Window::turned_degrees);
  if (speed > 20 || (as_radians > 0.4 && as_degrees < 0.5 * as_radians)) {
    return Sentence("the gyro seems to be in deg/s: it reads %.1f most of the time", speed) +
           (speed > 20 ? "" : ", and gravity does not turn as fast");
  }
  return "";
}

std::string GravityComplaint(const std::vector<ImuSample>& samples, const Eigen::Quaterniond& q_map_body) {
  if (samples.empty()) return "";
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const ImuSample& s : samples) force += s.accel;
  const Eigen::Vector3d up = q_map_body * force.normalized();
  const double degrees = std::acos(std::clamp(up.z(), -1.0, 1.0)) / kRadiansPerDegree;
  if (force.norm() < 0.1 * static_cast<double>(samples.size()) || degrees < 60) return "";
  return Sentence(
             "at the start the accelerometer's mean, which should point up, lies %.0f deg off the map's z "
             "axis: ",
             degrees) +
         "is the start pose that of the IMU (neither the camera's nor a marker's)? If so, " +
         (degrees > 120 ? "is the accelerometer's sign turned (it must read +9.81 along the axis that points "
                          "up), or does the map's z axis point down?"
                        : "does the map's z axis point up?");
}

}  // namespace evit
