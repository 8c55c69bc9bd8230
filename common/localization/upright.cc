#include "common/localization/upright.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/so3.h"

namespace evit {
namespace {

constexpr std::size_t kFewest = 10;
constexpr Utime kShortest = 80'000;    // us
constexpr Utime kBin = 25'000;         // us: of forces that are averaged
constexpr double kImplausible = 0.35;  // of gravity: a mean that differs by more, beyond its error, is none
constexpr double kLeastSigma = 0.5 / 57;  // rad: accelerometer bias and misalignment

// Motions of a person's hand, a robot's arm, a vehicle: their time scales, and strengths of acceleration.
constexpr std::array<double, 4> kScales{0.15, 0.25, 0.4, 0.8};  // s
constexpr std::array<double, 4> kStrengths{0.3, 1, 3, 8};       // m/s^2, rms
constexpr double kUsualSpeed = 1;                               // m/s, rms: much more is unlikely
// Steps and vibration, on top of that.
constexpr double kShakeScale = 0.06, kShake = 0.5;  // s; m/s^2
constexpr double kLeastNoise = 0.3;                 // m/s^2, of a bin's mean

struct Forces {
  Eigen::VectorXd t;               // s
  Eigen::Matrix<double, -1, 3> f;  // m/s^2, in the last sample's frame
  double noise = kLeastNoise;      // m/s^2, of each
};

// Correlation of the acceleration of a smooth motion (squared exponential in position) after `apart` scales.
double Correlation(double apart) {
  const double s = apart * apart;
  return (1 - 2 * s + s * s / 3) * std::exp(-0.5 * s);
}

Forces ForcesOf(const std::vector<ImuSample>& samples) {
  std::vector<Eigen::Vector4d> sums;  // force, time
  std::vector<double> counts;
  Eigen::Quaterniond R_last_k = Eigen::Quaterniond::Identity();
  const Utime last = samples.back().t;
  for (std::size_t k = samples.size(); k-- > 0;) {
    if (k + 1 < samples.size()) {
      const Eigen::Vector3d rate = 0.5 * (samples[k].gyro + samples[k + 1].gyro);
      R_last_k = (R_last_k * ExpSO3(-ToSeconds(samples[k + 1].t - samples[k].t) * rate)).normalized();
    }
    if (counts.empty() || (last - samples[k].t) / kBin > static_cast<Utime>(counts.size()) - 1) {
      sums.emplace_back(Eigen::Vector4d::Zero());
      counts.push_back(0);
    }
    const Eigen::Vector3d force = R_last_k * samples[k].accel;
    sums.back() += Eigen::Vector4d(force.x(), force.y(), force.z(), ToSeconds(last - samples[k].t));
    counts.back() += 1;
  }
  const auto n = static_cast<Eigen::Index>(counts.size());
  Forces forces{Eigen::VectorXd(n), Eigen::Matrix<double, -1, 3>(n, 3)};
  for (Eigen::Index k = 0; k < n; ++k) {
    forces.f.row(k) = sums[k].head<3>() / counts[k];
    forces.t[k] = sums[k][3] / counts[k];
  }
  if (n < 3) return forces;
  // Second differences: nothing of a smooth motion is left in them.
  const auto rough = forces.f.topRows(n - 2) - 2 * forces.f.middleRows(1, n - 2) + forces.f.bottomRows(n - 2);
  forces.noise =
      std::max(kLeastNoise, std::sqrt(rough.squaredNorm() / (3.0 * 6 * static_cast<double>(n - 2))));
  return forces;
}

// Gravity under one assumption about the motion.
struct Estimate {
  Eigen::Vector3d force;
  double variance;  // of each component
  double log_likelihood;
};
Estimate Solve(const Forces& forces, double scale, double strength) {
  const Eigen::Index n = forces.t.size();
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double apart = forces.t[i] - forces.t[j];
      covariance(i, j) = strength * strength * Correlation(apart / scale) +
                         kShake * kShake * Correlation(apart / kShakeScale);
    }
    covariance(i, i) += forces.noise * forces.noise;
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> solver(covariance);
  const Eigen::VectorXd weights = solver.solve(Eigen::VectorXd::Ones(n));
  const double information = weights.sum();
  Estimate estimate;
  estimate.force = forces.f.transpose() * weights / information;
  estimate.variance = 1 / information;
  const Eigen::Matrix<double, -1, 3> rest = forces.f.rowwise() - estimate.force.transpose();
  const double squares = rest.cwiseProduct(solver.solve(rest)).sum();
  const double log_root = solver.matrixLLT().diagonal().array().log().sum();
  const double speed = strength * scale / std::sqrt(3.0) / kUsualSpeed;
  estimate.log_likelihood = -0.5 * (squares + speed * speed) - 3 * log_root - 1.5 * std::log(information);
  return estimate;
}

}  // namespace

Upright EstimateUpright(const std::vector<ImuSample>& samples, double gravity) {
  Upright upright;
  if (samples.size() < kFewest || samples.back().t - samples.front().t < kShortest) return upright;
  const Forces forces = ForcesOf(samples);
  std::vector<Estimate> estimates;
  double most = -1e300;
  for (const double scale : kScales) {
    for (const double strength : kStrengths) {
      estimates.push_back(Solve(forces, scale, strength));
      most = std::max(most, estimates.back().log_likelihood);
    }
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double sum = 0, variance = 0;
  for (const Estimate& e : estimates) {
    const double weight = std::exp(e.log_likelihood - most);
    mean += weight * e.force;
    sum += weight;
  }
  mean /= sum;
  for (const Estimate& e : estimates) {
    const double weight = std::exp(e.log_likelihood - most) / sum;
    variance += weight * (e.variance + (e.force - mean).squaredNorm() / 3);
  }
  const double error = std::sqrt(variance);
  if (!(std::abs(mean.norm() - gravity) < kImplausible * gravity + 2 * error)) return upright;
  upright.known = true;
  upright.up = mean.normalized();
  upright.sigma = std::hypot(kLeastSigma, error / gravity);
  return upright;
}

}  // namespace evit
