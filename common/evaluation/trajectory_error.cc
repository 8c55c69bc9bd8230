#include "common/evaluation/trajectory_error.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace evit {
namespace {

struct Pair {
  Utime t;
  SE3 truth, estimate;
};

std::vector<Pair> MakePairs(const Trajectory& truth, const Trajectory& estimate) {
  std::vector<Pair> pairs;
  for (const StampedPose& e : estimate) {
    SE3 at;
    if (PoseAt(truth, e.t, &at)) pairs.push_back({e.t, at, e.pose});
  }
  return pairs;
}

// T_truth_estimate that the estimate is moved by.
SE3 Align(const std::vector<Pair>& pairs, Alignment alignment) {
  if (alignment == Alignment::kFirstPair) return pairs.front().truth * pairs.front().estimate.Inverse();
  if (alignment == Alignment::kNone) return {};
  // Umeyama 1991 without scale.
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  for (const Pair& p : pairs) a += p.truth.p, b += p.estimate.p;
  a /= static_cast<double>(pairs.size());
  b /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Pair& p : pairs) covariance += (p.truth.p - a) * (p.estimate.p - b).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign(2, 2) = -1;
  const Eigen::Matrix3d R = svd.matrixU() * sign * svd.matrixV().transpose();
  return {Eigen::Quaterniond(R).normalized(), a - R * b};
}

TrajectoryError ErrorOf(const std::vector<Pair>& pairs, const SE3& T_truth_estimate) {
  TrajectoryError error;
  error.n_pairs = static_cast<int>(pairs.size());
  if (pairs.empty()) return error;
  double position = 0, orientation = 0;
  for (const Pair& p : pairs) {
    const SE3 moved = T_truth_estimate * p.estimate;
    const double d = (moved.p - p.truth.p).norm(), angle = AngularDistance(moved.q, p.truth.q);
    position += d * d;
    orientation += angle * angle;
    error.position_max = std::max(error.position_max, d);
    error.orientation_max = std::max(error.orientation_max, angle);
  }
  error.position_rmse = std::sqrt(position / error.n_pairs);
  error.orientation_rmse = std::sqrt(orientation / error.n_pairs);
  return error;
}

double Coverage(const Trajectory& truth, const Trajectory& estimate) {
  if (truth.size() < 2 || estimate.empty()) return 0;
  const auto span = static_cast<double>(truth.back().t - truth.front().t);
  return std::clamp(static_cast<double>(estimate.back().t - truth.front().t) / span, 0.0, 1.0);
}

}  // namespace

TrajectoryError AbsoluteError(const Trajectory& truth, const Trajectory& estimate, Alignment alignment) {
  const std::vector<Pair> pairs = MakePairs(truth, estimate);
  TrajectoryError error = pairs.empty() ? TrajectoryError{} : ErrorOf(pairs, Align(pairs, alignment));
  error.coverage = Coverage(truth, estimate);
  return error;
}

TrajectoryError MilestoneError(const Trajectory& truth, const Trajectory& estimate, Alignment alignment,
                               double share) {
  if (truth.empty() || estimate.empty()) return {};
  const auto span = static_cast<double>(truth.back().t - truth.front().t);
  const Utime end = truth.front().t + std::llround(share * span);
  // Reached: the estimate comes within one keyframe interval of the milestone (a last keyframe is seldom
  // exactly there).
  constexpr Utime kTolerance = 250'000;
  if (estimate.back().t + kTolerance < end) return {};
  Trajectory part;
  std::copy_if(estimate.begin(), estimate.end(), std::back_inserter(part),
               [&](const StampedPose& s) { return s.t <= end; });
  return AbsoluteError(truth, part, alignment);
}

TrajectoryError RelativeError(const Trajectory& truth, const Trajectory& estimate, Utime delta) {
  std::vector<Pair> steps;
  for (const StampedPose& begin : estimate) {
    SE3 truth_a, truth_b, estimate_b;
    if (!PoseAt(truth, begin.t, &truth_a) || !PoseAt(truth, begin.t + delta, &truth_b) ||
        !PoseAt(estimate, begin.t + delta, &estimate_b)) {
      continue;
    }
    steps.push_back({begin.t, truth_a.Inverse() * truth_b, begin.pose.Inverse() * estimate_b});
  }
  TrajectoryError error = ErrorOf(steps, {});
  error.coverage = Coverage(truth, estimate);
  return error;
}

}  // namespace evit
