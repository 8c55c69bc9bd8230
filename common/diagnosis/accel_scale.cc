#include "common/diagnosis/accel_scale.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/diagnosis/rising_samples.h"
#include "common/geometry/so3.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kWindow = 3;        // s: the gyro's bias turns the frame by a degree or two in that
constexpr double kSlow = 0.05;       // m/s: what a rig that hardly moves may gain
constexpr double kBias = 0.03;       // of gravity: 30 mg, the bias of a consumer accelerometer
constexpr Utime kAround = 50'000;    // us: half of the time over which the truth's speed is taken
constexpr double kTruthSpeed = 0.1;  // m/s: error of that

// One window: the mean force and how the speed swings about its line, both along that mean.
struct Window {
  double seconds = 0, up = 0;
  double swing_squared = 0;  // (m/s)^2, mean
};

Window MeasureWindow(const std::vector<ImuSample>& samples, std::size_t begin, std::size_t end) {
  Window window;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  // body to body at the beginning
  Eigen::Vector3d gained = Eigen::Vector3d::Zero();
  std::vector<std::pair<double, Eigen::Vector3d>> way{{0, gained}};
  for (std::size_t k = begin; k + 1 < end; ++k) {
    const ImuSample &a = samples[k], &b = samples[k + 1];
    const double dt = ToSeconds(b.t - a.t);
    const Eigen::Vector3d before = q * a.accel;
    q = (q * ExpSO3(dt * (a.gyro + b.gyro) / 2)).normalized();
    gained += dt * (before + q * b.accel) / 2;
    window.seconds += dt;
    way.emplace_back(window.seconds, gained);
  }
  if (window.seconds <= 0) return window;
  const Eigen::Vector3d mean = gained / window.seconds;
  window.up = mean.norm();
  for (const auto& [t, speed] : way) {
    const double off = mean.normalized().dot(speed - t * mean);
    window.swing_squared += off * off / static_cast<double>(way.size());
  }
  return window;
}

// Vertical speed of the truth; false where it has no poses around.
bool UpwardSpeed(const Trajectory& truth, Utime t, double* speed) {
  SE3 a, b;
  if (truth.empty() || !PoseAt(truth, t - kAround, &a) || !PoseAt(truth, t + kAround, &b)) return false;
  *speed = (b.p.z() - a.p.z()) / ToSeconds(2 * kAround);
  return true;
}

}  // namespace

MeanForce MeasureMeanForce(const std::vector<ImuSample>& unordered, const Trajectory& truth) {
  const std::vector<ImuSample> samples = RisingSamples(unordered);
  MeanForce force;
  if (samples.size() < 100) return force;
  // What the truth covers, where it covers most.
  std::size_t begin = 0, end = samples.size();
  double at_begin = 0, at_end = 0;
  while (begin < end && !UpwardSpeed(truth, samples[begin].t, &at_begin)) ++begin;
  while (end > begin && !UpwardSpeed(truth, samples[end - 1].t, &at_end)) --end;
  const bool known = 2 * (end - begin) > samples.size();
  if (!known) begin = 0, end = samples.size();
  const double whole = ToSeconds(samples[end - 1].t - samples[begin].t);
  const auto n = static_cast<std::size_t>(std::max(1.0, std::round(whole / kWindow)));
  double swing = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t from = begin + (end - begin) * k / n, to = begin + (end - begin) * (k + 1) / n;
    const Window window = MeasureWindow(samples, from, std::min(to + 1, end));
    force.up += window.up * window.seconds, force.seconds += window.seconds;
    swing += window.swing_squared / static_cast<double>(n);
  }
  force.up /= force.seconds;
  if (known) force.up -= (at_end - at_begin) / force.seconds;
  // Speeds at the ends of a swing: as far apart as twice its root mean square, and half as much again because
  // the line through the ends hides a part of it.
  const double gained = known ? kTruthSpeed : std::max(kSlow, 2 * std::sqrt(swing));
  force.sigma = gained / force.seconds;
  return force;
}

Finding CheckAccelScale(const std::vector<ImuSample>& samples, const Trajectory& truth, double gravity) {
  const MeanForce force = MeasureMeanForce(samples, truth);
  if (force.seconds <= 0) return Good("imu-accel-scale", "too few samples to tell");
  const double off = force.up / gravity - 1;
  const std::string figure = FormatText("mean upward force %.2f +-%.2f m/s^2 over %.1f s, gravity %.2f",
                                        force.up, force.sigma, force.seconds, gravity);
  if (std::abs(off) * gravity > kBias * gravity + 4 * force.sigma) {
    return {
        "imu-accel-scale", Severity::kWarning, figure,
        FormatText("The accelerometer reads %.0f %% %s gravity on average: its scale is off, or its bias is "
                   "%.1f m/s^2.",
                   100 * std::abs(off), off > 0 ? "more than" : "less than", std::abs(off) * gravity),
        FormatText("look at the full-scale setting of sensor and driver; calibrate it in six positions at "
                   "rest, or multiply by %.3f",
                   gravity / force.up)};
  }
  return Good("imu-accel-scale", figure);
}

}  // namespace evit::diagnosis
