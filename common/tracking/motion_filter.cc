#include "common/tracking/motion_filter.h"

#include <Eigen/Cholesky>

#include "common/geometry/so3.h"

namespace evit {
namespace {

// Power of the accelerations, as those of a hand or a robot have: 5 m/s^2 and 20 rad/s^2 that last for a
// tenth of a second. It matters little (docs/results/trials.md).
constexpr double kAccelPower = 5, kAngularPower = 80;  // m^2/s^3, rad^2/s^3
constexpr double kSpeedSigma = 1, kRateSigma = 3;      // m/s, rad/s: before anything is known

template <int n>
Eigen::Matrix<double, n, n> Inverse(const Eigen::Matrix<double, n, n>& m) {
  return m.ldlt().solve(Eigen::Matrix<double, n, n>::Identity());
}

}  // namespace

void MotionFilter::Start(const SE3& T_map_body, const Matrix6d& information) {
  state_ = {T_map_body};
  Matrix12d known = Matrix12d::Zero();
  known.topLeftCorner<6, 6>() = information;
  known.diagonal().segment<3>(6).setConstant(1 / (kSpeedSigma * kSpeedSigma));
  known.diagonal().segment<3>(9).setConstant(1 / (kRateSigma * kRateSigma));
  covariance_ = Inverse<12>(known);
}

void MotionFilter::Predict(double seconds) {
  const double t = seconds;
  const Eigen::Matrix3d turn = ExpSO3(t * state_.rate).toRotationMatrix();
  Matrix12d F = Matrix12d::Identity();
  F.block<3, 3>(0, 6) = t * Eigen::Matrix3d::Identity();
  F.block<3, 3>(3, 9) = t * RightJacobianSO3(t * state_.rate);
  F.block<3, 3>(3, 3) = turn.transpose();
  covariance_ = (F * covariance_ * F.transpose()).eval();
  for (int i = 0; i < 6; ++i) {
    const double power = i < 3 ? kAccelPower : kAngularPower;
    covariance_(i, i) += power * t * t * t / 3;
    covariance_(i, i + 6) += power * t * t / 2;
    covariance_(i + 6, i) += power * t * t / 2;
    covariance_(i + 6, i + 6) += power * t;
  }
  state_.T_map_body.p += t * state_.velocity;
  state_.T_map_body.q = (state_.T_map_body.q * Eigen::Quaterniond(turn)).normalized();
}

Matrix6d MotionFilter::PoseInformation() const { return Inverse<6>(covariance_.topLeftCorner<6, 6>()); }

void MotionFilter::Update(const SE3& T_map_body, const Matrix6d& information) {
  const SE3& predicted = state_.T_map_body;
  Vector6d moved;
  moved << T_map_body.p - predicted.p, LogSO3(predicted.q.conjugate() * T_map_body.q);
  // What a pose elsewhere than predicted says of the velocities that led there.
  const Vector6d faster = covariance_.bottomLeftCorner<6, 6>() * (PoseInformation() * moved);
  state_.T_map_body = T_map_body;
  state_.velocity += faster.head<3>();
  state_.rate += faster.tail<3>();
  Matrix12d known = Inverse<12>(covariance_);
  known.topLeftCorner<6, 6>() += information;
  covariance_ = Inverse<12>(known);
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

}  // namespace evit
