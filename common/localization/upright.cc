#include "common/localization/upright.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/so3.h"

namespace evit {
namespace {

constexpr std::size_t kFewest = 10;
constexpr Utime kShortest = 100'000;      // us
constexpr double kImplausible = 0.35;     // of gravity: a mean that differs by more is none
constexpr double kLeastSigma = 0.5 / 57;  // rad: accelerometer bias and misalignment

// Mean of the forces with Hann's weights over [begin, end), which lie in one frame.
Eigen::Vector3d SoftMean(const std::vector<Eigen::Vector3d>& forces, std::size_t begin, std::size_t end) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const double phase = (static_cast<double>(k - begin) + 0.5) / static_cast<double>(end - begin);
    const double weight = 1 - std::cos(2 * EIGEN_PI * phase);
    sum += weight * forces[k];
    weights += weight;
  }
  return sum / weights;
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Upright EstimateUpright(const std::vector<ImuSample>& samples, double gravity) {
  Upright upright;
  if (samples.size() < kFewest || samples.back().t - samples.front().t < kShortest) return upright;
  std::vector<Eigen::Vector3d> forces(samples.size());
  Eigen::Quaterniond R_last_k = Eigen::Quaterniond::Identity();
  for (std::size_t k = samples.size(); k-- > 0;) {
    if (k + 1 < samples.size()) {
      const Eigen::Vector3d rate = 0.5 * (samples[k].gyro + samples[k + 1].gyro);
      R_last_k = (R_last_k * ExpSO3(-ToSeconds(samples[k + 1].t - samples[k].t) * rate)).normalized();
    }
    forces[k] = R_last_k * samples[k].accel;
  }
  const Eigen::Vector3d mean = SoftMean(forces, 0, forces.size());
  if (!(std::abs(mean.norm() - gravity) < kImplausible * gravity)) return upright;
  const std::size_t middle = forces.size() / 2;
  const double apart = AngleBetween(SoftMean(forces, 0, middle), SoftMean(forces, middle, forces.size()));
  upright.known = true;
  upright.up = mean.normalized();
  upright.sigma = std::max(kLeastSigma, 0.25 * apart);
  return upright;
}

}  // namespace evit
