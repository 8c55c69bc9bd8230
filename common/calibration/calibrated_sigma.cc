#include "common/calibration/calibrated_sigma.h"

namespace evit {
namespace {

// What a rig file may say (common/config/rig.proto).
constexpr double kMostRotation = 0.34, kMostTranslation = 1;  // rad: below 20 deg; m

// `value`: the unobservable directions that count.
Eigen::Vector3d SigmaByAxis(Eigen::Matrix3d covariance, const std::vector<Unobservable>& unobservable,
                            Unobservable::Value value, const Eigen::Vector3d& before, double most) {
  const bool stated = !before.isZero(0);
  for (const Unobservable& u : unobservable) {
    if (u.value != value || !stated) continue;
    const Eigen::Vector3d& axis = u.direction;  // an eigenvector
    const double kept = axis.dot(before.cwiseAbs2().asDiagonal() * axis);
    covariance += (kept - u.sigma * u.sigma) * axis * axis.transpose();
  }
  return covariance.diagonal().cwiseMax(0).cwiseSqrt().cwiseMin(most);
}

}  // namespace

ExtrinsicsSigma CalibratedSigma(const Matrix6d& covariance, const std::vector<Unobservable>& unobservable,
                                const ExtrinsicsSigma& before) {
  return {SigmaByAxis(covariance.bottomRightCorner<3, 3>(), unobservable, Unobservable::Value::kRotation,
                      before.rotation, kMostRotation),
          SigmaByAxis(covariance.topLeftCorner<3, 3>(), unobservable, Unobservable::Value::kTranslation,
                      before.translation, kMostTranslation)};
}

}  // namespace evit
