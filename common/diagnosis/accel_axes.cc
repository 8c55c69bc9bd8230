#include "common/diagnosis/accel_axes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/diagnosis/rising_samples.h"
#include "common/diagnosis/signed_permutations.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kAccelHalf = 80'000,
                kAccelStep = 20'000;  // us: over which poses of a millimetre tell accelerations
constexpr double kWrongForce = 1;     // m/s^2: more than biases and errors of poses leave
constexpr int kFewestForces = 30;

// Mean of the readings around t, weighted as a second difference of positions weights accelerations; false
// where they do not cover it.
bool MeanReading(const std::vector<ImuSample>& samples, Utime t, Eigen::Vector3d* mean) {
  const auto before = [](const ImuSample& s, Utime time) { return s.t < time; };
  auto it = std::lower_bound(samples.begin(), samples.end(), t - kAccelHalf, before);
  if (it == samples.begin() || samples.back().t < t + kAccelHalf) return false;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0;
  for (; it != samples.end() && it->t <= t + kAccelHalf; ++it) {
    const double weight = 1 - static_cast<double>(std::abs(it->t - t)) / static_cast<double>(kAccelHalf);
    sum += weight * it->accel, weights += weight;
  }
  if (weights <= 0) return false;
  *mean = sum / weights;
  return true;
}

}  // namespace

AccelAxesFit FitAccelAxes(const std::vector<ImuSample>& unordered, const Trajectory& truth, double gravity) {
  AccelAxesFit fit;
  const std::vector<ImuSample> samples = RisingSamples(unordered);
  if (samples.empty() || truth.empty()) return fit;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;  // reading, force by the poses; body axes
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> in_map;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (Utime t = truth.front().t + kAccelHalf; t + kAccelHalf <= truth.back().t; t += kAccelStep) {
    SE3 a, b, c;
    Eigen::Vector3d reading;
    if (!MeanReading(samples, t, &reading) || !PoseAt(truth, t - kAccelHalf, &a) || !PoseAt(truth, t, &b) ||
        !PoseAt(truth, t + kAccelHalf, &c))
      continue;
    const Eigen::Vector3d acceleration = (a.p - 2 * b.p + c.p) / std::pow(ToSeconds(kAccelHalf), 2);
    pairs.emplace_back(reading, b.q.conjugate() * (acceleration + Eigen::Vector3d(0, 0, gravity)));
    in_map.emplace_back(b.q * reading, acceleration);
    mean += b.q * reading - acceleration;
  }
  fit.n = static_cast<int>(pairs.size());
  if (fit.n < kFewestForces) return fit;
  const auto rms = [&pairs](const Eigen::Matrix3d& axes) {
    double sum = 0;
    for (const auto& [reading, force] : pairs) sum += (axes * reading - force).squaredNorm();
    return std::sqrt(sum / static_cast<double>(pairs.size()));
  };
  fit.as_read = fit.best = rms(Eigen::Matrix3d::Identity());
  for (const Eigen::Matrix3d& axes : SignedPermutations()) {
    const double off = rms(axes);
    if (off < fit.best) fit.best = off, fit.axes = axes;
  }
  const Eigen::Vector3d force = gravity * mean.normalized();
  for (const auto& [reading, acceleration] : in_map)
    fit.tilted += (reading - acceleration - force).squaredNorm() / fit.n;
  fit.tilted = std::sqrt(fit.tilted);
  return fit;
}

Finding CheckAccelAxes(const std::vector<ImuSample>& samples, const Trajectory& truth, double gravity) {
  const AccelAxesFit fit = FitAccelAxes(samples, truth, gravity);
  if (fit.n < kFewestForces) return Good("imu-accel-axes", "too few poses to tell");
  const std::string figure = FormatText(
      "%.2f m/s^2 (rms) off what the poses tell; with other axes at best %.2f", fit.as_read, fit.best);
  if (fit.as_read < kWrongForce || fit.best > 0.6 * fit.as_read || fit.tilted < 1.3 * fit.best)
    return Good("imu-accel-axes", figure);
  std::string axes;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      if (fit.axes(row, column) != 0)
        axes += FormatText("%s%s%c", axes.empty() ? "" : ", ", fit.axes(row, column) < 0 ? "-" : "",
                           'x' + column);
  return {
      "imu-accel-axes", Severity::kError, figure,
      "The accelerometer's axes are swapped or mirrored: its x, y, z should be " + axes + ".",
      "give accelerometer and gyro in one right-handed body frame, as the rig file's T_body_camera has it"};
}

}  // namespace evit::diagnosis
