#include "tools/simulation/pose_spline.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace evit::simulation {
namespace {

constexpr int kOrder = PoseSpline::kOrder;
using BasisMatrix = std::array<std::array<double, kOrder>, kOrder>;  // [control point][power of u]

double Binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

// Qin, "General matrix representations for B-splines", 2000, eq. for uniform knots.
BasisMatrix MakeBasisMatrix() {
  BasisMatrix m{};
  double factorial = 1;
  for (int i = 2; i < kOrder; ++i) factorial *= i;
  for (int s = 0; s < kOrder; ++s) {
    for (int n = 0; n < kOrder; ++n) {
      double sum = 0;
      for (int l = s; l < kOrder; ++l) {
        sum += ((l - s) % 2 ? -1.0 : 1.0) * Binomial(kOrder, l - s) *
               std::pow(static_cast<double>(kOrder - 1 - l), kOrder - 1 - n);
      }
      m[s][n] = Binomial(kOrder - 1, n) / factorial * sum;
    }
  }
  return m;
}

// Sum over the control points from j on: the cumulative basis.
std::array<double, kOrder> Cumulative(std::array<double, kOrder> basis) {
  for (int j = kOrder - 2; j >= 0; --j) basis[j] += basis[j + 1];
  return basis;
}

using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

void CheckPoses(const Trajectory& poses, double knot_spacing) {
  if (!(knot_spacing > 1e-3)) throw std::runtime_error("knot spacing must be over 1 ms");
  constexpr std::size_t kFewest = 12;
  if (poses.size() < kFewest) {
    throw std::runtime_error("trajectory has " + std::to_string(poses.size()) + " poses; needs at least " +
                             std::to_string(kFewest));
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].t <= poses[i - 1].t) throw std::runtime_error("trajectory stamps do not increase");
  }
}

// Rows from `row` on: third differences of the n control points. Weak against the data (weight 1 per pose),
// yet enough to bridge segments without any.
void PenaliseJerk(int row, int n, std::vector<Eigen::Triplet<double>>* entries) {
  constexpr double kWeight = 1e-2;
  constexpr std::array<double, 4> kDifference{-1, 3, -3, 1};
  for (int i = 0; i + 3 < n; ++i) {
    for (int j = 0; j < 4; ++j) entries->emplace_back(row + i, i + j, kWeight * kDifference[j]);
  }
}

}  // namespace

std::array<double, kOrder> SplineBasis(double u, int derivative) {
  static const BasisMatrix matrix = MakeBasisMatrix();
  std::array<double, kOrder> value{};
  for (int s = 0; s < kOrder; ++s) {
    for (int n = kOrder - 1; n >= derivative; --n) {
      double factor = 1;
      for (int i = 0; i < derivative; ++i) factor *= n - i;
      value[s] = value[s] * u + factor * matrix[s][n];
    }
  }
  return value;
}

PoseSpline::Place PoseSpline::Find(Utime t) const {
  const double s = ToSeconds(t - begin_) / spacing_;
  const int last = static_cast<int>(positions_.size()) - kOrder;
  const int first = std::clamp(static_cast<int>(s), 0, last);
  return {first, s - first};
}

PoseSpline::Sample PoseSpline::Evaluate(Utime t) const {
  const Place place = Find(t);
  const auto b0 = SplineBasis(place.u, 0), b1 = SplineBasis(place.u, 1), b2 = SplineBasis(place.u, 2);
  Sample out{{}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int j = 0; j < kOrder; ++j) {
    const Eigen::Vector3d& c = positions_[place.first + j];
    out.pose.p += b0[j] * c;
    out.velocity += b1[j] / spacing_ * c;
    out.acceleration += b2[j] / (spacing_ * spacing_) * c;
  }
  const auto c0 = Cumulative(b0), c1 = Cumulative(b1);
  out.pose.q = rotations_[place.first];
  for (int j = 1; j < kOrder; ++j) {
    const Eigen::Vector3d d =
        LogSO3(rotations_[place.first + j - 1].conjugate() * rotations_[place.first + j]);
    const Eigen::Quaterniond step = ExpSO3(c0[j] * d);
    out.pose.q = out.pose.q * step;
    out.rate = step.conjugate() * out.rate + c1[j] / spacing_ * d;
  }
  out.pose.q.normalize();
  return out;
}

PoseSpline PoseSpline::Moved(const SE3& T_new_old) const {
  PoseSpline moved = *this;
  for (Eigen::Vector3d& p : moved.positions_) p = T_new_old * p;
  for (Eigen::Quaterniond& q : moved.rotations_) q = (T_new_old.q * q).normalized();
  return moved;
}

void PoseSpline::FitRotations(const Trajectory& poses, const Solve& solve) {
  const int n = static_cast<int>(rotations_.size());
  // Start from the nearest pose, then Gauss-Newton: near the solution, turning control point j by a small
  // delta_j turns the curve by about sum_j basis_j * delta_j, so every step is the same linear problem.
  for (int i = 0; i < n; ++i) {
    const double centre = (i - 0.5 * (kDegree - 1)) * spacing_;
    const Utime t = begin_ + static_cast<Utime>(std::llround(centre * 1e6));
    const auto after = std::lower_bound(poses.begin(), poses.end(), t,
                                        [](const StampedPose& p, Utime value) { return p.t < value; });
    rotations_[i] = (after == poses.end() ? poses.back() : *after).pose.q.normalized();
  }
  Eigen::MatrixX3d errors(static_cast<Eigen::Index>(poses.size()), 3);
  for (int iteration = 0; iteration < 12; ++iteration) {
    for (Eigen::Index i = 0; i < errors.rows(); ++i) {
      errors.row(i) = LogSO3(Pose(poses[i].t).q.conjugate() * poses[i].pose.q).transpose();
    }
    const Eigen::MatrixX3d delta = solve(errors);
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d turn = delta.row(i).transpose();
      rotations_[i] = (rotations_[i] * ExpSO3(turn)).normalized();
    }
    if (delta.cwiseAbs().maxCoeff() < 1e-10) break;
  }
}

PoseSpline PoseSpline::Fit(const Trajectory& poses, double knot_spacing) {
  CheckPoses(poses, knot_spacing);
  PoseSpline spline;
  spline.begin_ = poses.front().t;
  spline.end_ = poses.back().t;
  spline.spacing_ = knot_spacing;
  const double length = ToSeconds(spline.end_ - spline.begin_);
  const int n = static_cast<int>(std::floor(length / knot_spacing)) + 1 + kDegree;
  const int m = static_cast<int>(poses.size());
  spline.positions_.assign(n, Eigen::Vector3d::Zero());
  spline.rotations_.resize(n);

  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < m; ++i) {
    const Place place = spline.Find(poses[i].t);
    const auto basis = SplineBasis(place.u, 0);
    for (int j = 0; j < kOrder; ++j) entries.emplace_back(i, place.first + j, basis[j]);
  }
  PenaliseJerk(m, n, &entries);
  Eigen::SparseMatrix<double> a(m + n - 3, n);
  a.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> at = a.transpose();
  const Solver solver(Eigen::SparseMatrix<double>(at * a));
  if (solver.info() != Eigen::Success) throw std::runtime_error("cannot fit a spline to the trajectory");
  const Solve solve = [&](const Eigen::MatrixX3d& b) -> Eigen::MatrixX3d {
    return solver.solve(at.leftCols(m) * b);
  };

  Eigen::MatrixX3d positions(m, 3);
  for (int i = 0; i < m; ++i) positions.row(i) = poses[i].pose.p.transpose();
  const Eigen::MatrixX3d control = solve(positions);
  for (int i = 0; i < n; ++i) spline.positions_[i] = control.row(i).transpose();
  spline.FitRotations(poses, solve);
  return spline;
}

}  // namespace evit::simulation
