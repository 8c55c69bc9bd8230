#include "common/evaluation/trajectory_error.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "common/evaluation/trajectory_pairs.h"

namespace evit {
namespace {

using Pairs = std::vector<TrajectoryPair>;

// Nor do positions that spread across by less than this share of what they do along.
constexpr double kMinSpread = TrajectoryError::kMinSpread, kMinSpreadRatio = 0.02;

// Standard deviations of positions along their main direction and along the next one, m.
struct Spread {
  double along = 0, across = 0;
  bool extended() const { return along > kMinSpread; }
  bool planar() const { return across > kMinSpread && across > kMinSpreadRatio * along; }
};

Spread SpreadOf(const Pairs& pairs, SE3 TrajectoryPair::*side) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const TrajectoryPair& p : pairs) mean += (p.*side).p;
  mean /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const TrajectoryPair& p : pairs)
    covariance += ((p.*side).p - mean) * ((p.*side).p - mean).transpose() / static_cast<double>(pairs.size());
  const Eigen::Vector3d variances =  // ascending
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  return {std::sqrt(std::max(0.0, variances[2])), std::sqrt(std::max(0.0, variances[1]))};
}

// What the estimate is moved by: scaled, then T_truth_estimate.
struct Move {
  SE3 T;
  double scale = 1;

  SE3 Of(const SE3& estimate) const { return T * SE3(estimate.q, scale * estimate.p); }
};

bool ByPositions(Alignment alignment) {
  return alignment == Alignment::kUmeyama || alignment == Alignment::kScaled;
}

Move Align(const Pairs& pairs, Alignment alignment) {
  if (alignment == Alignment::kFirstPair) return {pairs.front().truth * pairs.front().estimate.Inverse()};
  if (alignment == Alignment::kNone) return {};
  // Umeyama 1991.
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  for (const TrajectoryPair& p : pairs) a += p.truth.p, b += p.estimate.p;
  a /= static_cast<double>(pairs.size());
  b /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double spread = 0;
  for (const TrajectoryPair& p : pairs) {
    covariance += (p.truth.p - a) * (p.estimate.p - b).transpose();
    spread += (p.estimate.p - b).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign(2, 2) = -1;
  const Eigen::Matrix3d R = svd.matrixU() * sign * svd.matrixV().transpose();
  const double scale =
      alignment == Alignment::kScaled ? (svd.singularValues().asDiagonal() * sign).trace() / spread : 1;
  return {{Eigen::Quaterniond(R).normalized(), a - scale * (R * b)}, scale};
}

TrajectoryError ErrorOf(const Pairs& pairs, const Move& move) {
  TrajectoryError error;
  error.n_pairs = static_cast<int>(pairs.size());
  if (pairs.empty()) return error;
  double position = 0, orientation = 0;
  for (const TrajectoryPair& p : pairs) {
    const SE3 moved = move.Of(p.estimate);
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

double Reached(const Trajectory& truth, const Trajectory& estimate) {
  if (truth.size() < 2 || estimate.empty()) return 0;
  const auto span = static_cast<double>(truth.back().t - truth.front().t);
  return std::clamp(static_cast<double>(estimate.back().t - truth.front().t) / span, 0.0, 1.0);
}

}  // namespace

TrajectoryError AbsoluteError(const Trajectory& truth, const Trajectory& estimate, Alignment alignment) {
  const Pairs pairs = MakePairs(truth, estimate);
  TrajectoryError error;
  error.n_pairs = static_cast<int>(pairs.size());
  if (ByPositions(alignment) && !pairs.empty()) {
    const Spread truth_spread = SpreadOf(pairs, &TrajectoryPair::truth),
                 spread = SpreadOf(pairs, &TrajectoryPair::estimate);
    error.oriented = truth_spread.planar() && spread.planar();
    error.scaled = alignment != Alignment::kScaled || (truth_spread.extended() && spread.extended());
  }
  if (error.scored()) {
    const bool oriented = error.oriented;
    error = ErrorOf(pairs, Align(pairs, alignment));
    error.oriented = oriented;
  }
  error.reached = Reached(truth, estimate);
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
  const Utime truth_hole = MaxHole(truth), estimate_hole = MaxHole(estimate);
  Pairs steps;
  for (const TrajectoryPair& begin : MakePairs(truth, estimate)) {
    SE3 truth_b, estimate_b;
    if (!PoseAt(truth, begin.t + delta, &truth_b, truth_hole) ||
        !PoseAt(estimate, begin.t + delta, &estimate_b, estimate_hole)) {
      continue;
    }
    steps.push_back({begin.t, begin.truth.Inverse() * truth_b, begin.estimate.Inverse() * estimate_b});
  }
  TrajectoryError error = ErrorOf(steps, {});
  error.reached = Reached(truth, estimate);
  return error;
}

}  // namespace evit
