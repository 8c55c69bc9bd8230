#include "common/diagnosis/rate_fit.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/diagnosis/sample_integral.h"
#include "common/geometry/so3.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kRateHalf = 25'000, kRateStep = 20'000, kLagStep = 5'000;  // us

struct Rates {
  Utime t;
  Eigen::Vector3d of_truth;  // rad/s over [t - kRateHalf, t + kRateHalf], body axes
};

std::vector<Rates> RatesOf(const Trajectory& truth) {
  std::vector<Rates> rates;
  if (truth.size() < 2) return rates;
  for (Utime t = truth.front().t + kRateHalf; t + kRateHalf <= truth.back().t; t += kRateStep) {
    SE3 a, b;
    if (!PoseAt(truth, t - kRateHalf, &a) || !PoseAt(truth, t + kRateHalf, &b)) continue;
    rates.push_back({t, LogSO3(a.q.conjugate() * b.q) / ToSeconds(2 * kRateHalf)});
  }
  return rates;
}

// The best R and scale at one lag, by the singular values of the cross-covariance (Kabsch).
RateFit FitAt(const std::vector<Rates>& rates, const SampleIntegral& gyro, Utime lag) {
  RateFit fit;
  fit.lag = lag;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  for (const Rates& r : rates) {
    Eigen::Vector3d measured;
    if (!gyro.Mean(r.t + lag - kRateHalf, r.t + lag + kRateHalf, &measured)) continue;
    pairs.emplace_back(r.of_truth, measured);
    mean_a += r.of_truth, mean_b += measured;
  }
  fit.n = static_cast<int>(pairs.size());
  if (fit.n < 20) return fit;
  mean_a /= fit.n, mean_b /= fit.n;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double aa = 0, bb = 0;
  for (const auto& [a, b] : pairs) {
    cross += (b - mean_b) * (a - mean_a).transpose();
    aa += (a - mean_a).squaredNorm(), bb += (b - mean_b).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  fit.R = svd.matrixU() * svd.matrixV().transpose();
  // A mirror image only where it explains clearly more: rotation about one axis leaves the sign of another
  // open.
  const double mirrored = svd.singularValues().sum();
  if (fit.R.determinant() < 0) {
    const Eigen::Vector3d keep(1, 1, -1);
    const double proper = svd.singularValues().dot(keep);
    if (proper > 0.8 * mirrored) fit.R = svd.matrixU() * keep.asDiagonal() * svd.matrixV().transpose();
  }
  const double agreement = (fit.R.transpose() * cross).trace();
  fit.rate = std::sqrt(aa / fit.n);
  fit.scale = agreement / std::max(aa, 1e-12);
  fit.bias = mean_b - fit.scale * mean_a;
  const auto explained = [aa, bb](double sum) { return sum > 0 ? sum * sum / std::max(aa * bb, 1e-18) : 0; };
  fit.explained = explained(agreement);
  fit.explained_unturned = explained(cross.trace());
  return fit;
}

}  // namespace

RateFit FitRates(const Trajectory& truth, const std::vector<ImuSample>& imu, Utime reach) {
  const std::vector<Rates> rates = RatesOf(truth);
  const SampleIntegral gyro(imu, true);
  const RateFit as_is = FitAt(rates, gyro, 0);
  RateFit best = as_is;
  for (Utime lag = -reach; lag <= reach; lag += kLagStep) {
    const RateFit fit = FitAt(rates, gyro, lag);
    // A lag that leaves little overlap proves nothing.
    if (2 * fit.n >= as_is.n && fit.n >= 50 && fit.explained > best.explained) best = fit;
  }
  best.explained_as_is = as_is.explained;
  return best;
}

}  // namespace evit::diagnosis
