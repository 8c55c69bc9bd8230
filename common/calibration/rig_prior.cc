#include "common/calibration/rig_prior.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/geometry/degrees.h"

namespace evit {
namespace {

constexpr double kTranslation = 0.01, kRotation = kRadiansPerDegree, kOffset = 0.005;  // m, rad, s
constexpr double kLearned = 0.25;  // of the prior's variance, left
constexpr double kSure = 2;        // sigmas: 95 %

}  // namespace

RigVector RigPriorSigma(const Rig& rig) {
  const auto stated = [](const Eigen::Vector3d& sigma, double otherwise) -> Eigen::Vector3d {
    return sigma.unaryExpr([otherwise](double s) { return s > 0 ? s : otherwise; });
  };
  RigVector sigma;
  sigma << stated(rig.T_body_camera_sigma.translation, kTranslation),
      stated(rig.T_body_camera_sigma.rotation, kRotation), kOffset;
  return sigma;
}

bool RigDirection::learned() const { return moved || variance <= kLearned; }

bool RigUpdate::learned_any() const {
  return std::any_of(directions.begin(), directions.end(), [](const RigDirection& d) { return d.learned(); });
}

RigUpdate UpdateRig(const RigVector& prior_sigma, double lag_sigma, const RigVector& found,
                    const RigMatrix& covariance) {
  // Offset and lag share what was found of their sum by their variances.
  RigVector share = RigVector::Ones(), sum_variance = prior_sigma.cwiseAbs2();
  sum_variance[6] += lag_sigma * lag_sigma;
  share[6] = prior_sigma[6] * prior_sigma[6] / sum_variance[6];
  const RigMatrix G = share.asDiagonal(), sum_prior = sum_variance.asDiagonal();
  const RigMatrix learned = G * (sum_prior - covariance) * G;  // how much less than the prior's covariance

  const RigMatrix S = prior_sigma.asDiagonal(), S_inv = prior_sigma.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<RigMatrix> axes(S_inv * learned * S_inv);
  RigUpdate update;
  for (int k = 0; k < 7; ++k) {
    RigDirection d;
    d.one_sigma = S * axes.eigenvectors().col(k);
    d.posterior_variance = std::clamp(1 - axes.eigenvalues()[k], 0.0, 1.0);
    d.posterior_mean = axes.eigenvectors().col(k).dot(S_inv * G * found);
    d.observable = d.posterior_variance <= kLearned;
    const double off2 = d.posterior_mean * d.posterior_mean;
    d.moved = d.observable && off2 >= kSure * kSure * d.posterior_variance;
    if (d.moved) {
      update.change += d.posterior_mean * d.one_sigma;
      d.variance = d.posterior_variance;
    } else if (d.observable) {
      d.variance = std::min(1.0, d.posterior_variance + off2);
    }
    update.covariance += d.variance * d.one_sigma * d.one_sigma.transpose();
    update.directions.push_back(d);
  }
  return update;
}

}  // namespace evit
