#include "common/localization/motion_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/imu/propagation.h"

namespace evit {
namespace {

constexpr std::size_t kFewest = 6;
// m: error of a pose found from its events. On real recordings it is 5 to 10 mm and changes only with the
// view: neighbouring poses err alike, so that the residuals of a fit do not show it.
constexpr double kPoseSigma = 0.01;
constexpr double kTurnSigma = 0.005;  // rad: the same, of its rotation
constexpr double kGyroBias = 0.01;    // rad/s, of a calibrated sensor
constexpr double kConstant = 0.2;  // m/s^2: bias of the accelerometer, and gravity through a tilt of a degree
constexpr double kSameScale = 0.1;  // a tenth is within what maps from pictures have
constexpr std::size_t kAstray = 4;  // one of so many poses may be left out
constexpr double kTogether = 6;     // steps that err together: neighbours see the same part of the map
constexpr int kUnknowns = 10;       // start, velocity, constant acceleration, scale

using Vector10 = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix10 = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Steps = std::vector<FollowedPlace::Step>;

// Where the IMU alone says that the body is at a step: from the origin, at rest at the first.
struct Moved {
  SE3 pose;
  Eigen::Matrix3d turned;  // s: integral of the rotation, by which a bias of the gyro turns it
};

std::vector<Moved> MoveByImu(const Steps& steps, const std::vector<ImuSample>& samples,
                             const Eigen::Quaterniond& start, const ImuBias& bias, double gravity) {
  std::vector<Moved> moved;
  NavState state{{start, Eigen::Vector3d::Zero()}, Eigen::Vector3d::Zero()};
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  std::size_t next = 1;
  for (const FollowedPlace::Step& step : steps) {
    for (; next < samples.size() && samples[next].t <= step.t; ++next) {
      turned += ToSeconds(samples[next].t - samples[next - 1].t) * state.T_map_body.q.toRotationMatrix();
      state = PropagateImu(state, {samples[next - 1], samples[next]}, bias, gravity);
    }
    moved.push_back({state.T_map_body, turned});
  }
  return moved;
}

// The rotation at the first step and the bias of the gyro that all steps agree on best: between them the gyro
// knows the turns far better than any of them does.
struct Attitude {
  Eigen::Quaterniond start;
  ImuBias bias;
};
Attitude FitAttitude(const Steps& steps, const std::vector<ImuSample>& samples, double gravity) {
  const Eigen::Quaterniond first = steps.front().T_map_body.q;
  const std::vector<Moved> moved = MoveByImu(steps, samples, first, {}, gravity);
  Matrix6 information = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  information.diagonal().tail<3>().setConstant(kTurnSigma * kTurnSigma / (kGyroBias * kGyroBias));
  for (std::size_t k = 0; k < steps.size(); ++k) {
    Eigen::Matrix<double, 3, 6> row;
    row << Eigen::Matrix3d::Identity(), -moved[k].turned;
    information += row.transpose() * row;
    right += row.transpose() * LogSO3(steps[k].T_map_body.q * moved[k].pose.q.conjugate());
  }
  const Vector6 x = information.ldlt().solve(right);
  return {ExpSO3(x.head<3>()) * first, {x.tail<3>(), Eigen::Vector3d::Zero()}};
}

// The motion that some of the steps agree on best.
struct Fitted {
  Vector10 x;
  double scale_spread;        // sigma of the scale for poses of sigma 1 m
  std::vector<double> off_m;  // of each of these steps
};
Fitted FitSteps(const Steps& steps, const std::vector<Moved>& moved,
                const std::vector<std::size_t>& fitting) {
  Matrix10 information = Matrix10::Zero();
  Vector10 right = Vector10::Zero();
  information.diagonal().segment<3>(6).setConstant(kPoseSigma * kPoseSigma / (kConstant * kConstant));
  const Eigen::Vector3d origin = steps.front().T_map_body.p;
  std::vector<Eigen::Matrix<double, 3, kUnknowns>> rows;
  for (const std::size_t k : fitting) {
    const double t = ToSeconds(steps[k].t - steps.front().t);
    Eigen::Matrix<double, 3, kUnknowns> row;
    row << Eigen::Matrix3d::Identity(), t * Eigen::Matrix3d::Identity(),
        0.5 * t * t * Eigen::Matrix3d::Identity(), moved[k].pose.p;
    information += row.transpose() * row;
    right += row.transpose() * (steps[k].T_map_body.p - origin);
    rows.push_back(row);
  }
  const Eigen::LDLT<Matrix10> solver(information);
  const Vector10 last = Vector10::Unit(kUnknowns - 1);
  Fitted fitted{solver.solve(right), std::sqrt(std::max(0.0, last.dot(solver.solve(last)))), {}};
  for (std::size_t k = 0; k < rows.size(); ++k)
    fitted.off_m.push_back((rows[k] * fitted.x - (steps[fitting[k]].T_map_body.p - origin)).norm());
  return fitted;
}

}  // namespace

bool MotionFit::Disagrees() const { return std::abs(scale - 1) > kSameScale + 3 * scale_sigma; }

std::optional<MotionFit> FitMotion(const std::vector<FollowedPlace::Step>& steps,
                                   const std::vector<ImuSample>& samples, double gravity) {
  if (steps.size() < kFewest || samples.size() < 2) return std::nullopt;
  const Attitude attitude = FitAttitude(steps, samples, gravity);
  const std::vector<Moved> moved = MoveByImu(steps, samples, attitude.start, attitude.bias, gravity);
  MotionFit fit;
  fit.fitting.resize(steps.size());
  std::iota(fit.fitting.begin(), fit.fitting.end(), std::size_t{0});
  const std::size_t fewest = std::max(kFewest, steps.size() - steps.size() / kAstray);
  Fitted fitted = FitSteps(steps, moved, fit.fitting);
  while (fit.fitting.size() > fewest) {
    std::vector<double> off = fitted.off_m;
    const auto worst = std::max_element(fitted.off_m.begin(), fitted.off_m.end());
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
    if (*worst < std::max(2 * kPoseSigma, 3 * off[off.size() / 2])) break;
    fit.fitting.erase(fit.fitting.begin() + (worst - fitted.off_m.begin()));
    fitted = FitSteps(steps, moved, fit.fitting);
  }
  double squares = 0;
  for (const double off : fitted.off_m) squares += off * off;
  const auto n = static_cast<double>(fit.fitting.size());
  fit.scale = fitted.x[kUnknowns - 1];
  fit.misfit = std::sqrt(squares / n);
  const double sigma = std::max(kPoseSigma, std::sqrt(squares / (3 * n - 7)));
  fit.scale_sigma = sigma * std::sqrt(kTogether) * fitted.scale_spread;
  return fit;
}

}  // namespace evit
