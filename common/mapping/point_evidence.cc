#include "common/mapping/point_evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr double kLongestStep = 0.03;  // m
// What is left of a direction where it is turned, nearly the cosine of the angle: less, and the views do not
// show one line.
constexpr double kOneLine = 0.8;

// How many of so many views count as independent: poses' errors do not average out over neighbouring ones.
double Independent(double seen) { return seen / std::max(1.0, std::min(10.0, seen / 3)); }

// Each view's edge and the camera span a plane that holds the line: seen from different places, these planes
// tell how it slants, which its neighbours' depths tell badly where it is short and far. With a wrong slant,
// what a point's depth is off would seem to be along its line, and of no account. `information`: about the
// point's position, of the views (m^-2).
void AlignWithViews(const Eigen::Matrix3d& information, double independent,
                    const EdgeAdjustmentOptions& options, Eigen::Vector3d* direction) {
  const double trace = information.trace();
  if (!(trace > 0)) return;
  // A step of a metre across is an angle of fx / z pixels: the trace has it.
  const Eigen::Matrix3d planes =
      independent / (options.normal_sigma * options.normal_sigma) / trace * information;
  const Eigen::Matrix3d held =
      Eigen::Matrix3d::Identity() / (options.direction_sigma * options.direction_sigma);
  const Eigen::Vector3d turned = *direction - (planes + held).ldlt().solve(planes * *direction);
  if (turned.allFinite() && turned.norm() > kOneLine) *direction = turned.normalized();
}

}  // namespace

void PointEvidence::Add(const EdgeSighting& sighting, const PinholeView& view, double edge_sigma_px) {
  ++expected_;
  if (!sighting.found) return;
  const double w = sighting.Weight(edge_sigma_px);
  const Eigen::RowVector3d j = sighting.by_point * view.R;
  information_ += w * j.transpose() * j;
  gradient_ += w * sighting.off * j.transpose();
  by_lag_ -= w * sighting.way * j.transpose();
  lag_information_ += w * sighting.way * sighting.way;
  lag_gradient_ -= w * sighting.off * sighting.way;
  if (sighting.Agrees()) ++seen_;
}

void PointEvidence::Add(const PointEvidence& other) {
  information_ += other.information_;
  gradient_ += other.gradient_;
  by_lag_ += other.by_lag_;
  lag_information_ += other.lag_information_;
  lag_gradient_ += other.lag_gradient_;
  expected_ += other.expected_;
  seen_ += other.seen_;
}

void PointEvidence::Fit(const MappedPoint& measured, bool move, const EdgeAdjustmentOptions& options,
                        MappedPoint* point) const {
  AlignWithViews(information_, Independent(seen_), options, &point->direction);
  // Of the lag nothing but its prior is known where there are no event views, and nothing changes.
  const double lag_variance = options.lag_sigma_px * options.lag_sigma_px;
  const double lag_information = lag_information_ + 1 / lag_variance;
  const double lag_gradient = lag_gradient_ + point->lag / lag_variance;
  Eigen::Matrix3d information = information_ - by_lag_ * by_lag_.transpose() / lag_information;
  Eigen::Vector3d gradient = gradient_ - by_lag_ * lag_gradient / lag_information;
  if (options.hold_sigmas > 0) {
    const double sigma = options.hold_sigmas * measured.sigma;
    const double per_m2 = 1 / (sigma * sigma + 1e-8);
    information.diagonal().array() += per_m2;
    gradient += per_m2 * (point->position - measured.position);
  }
  // Along the line nothing is known: the point stays where it is.
  const double held = information.trace() + 1;
  information += held * point->direction * point->direction.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information);
  const double weakest = solver.eigenvalues()[0];
  point->sigma = weakest > 0 ? std::sqrt(seen_ / Independent(seen_) / weakest) : 1;
  if (!move || !(weakest > 0)) return;
  Eigen::Vector3d step = -solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
                         solver.eigenvectors().transpose() * gradient;
  step -= step.dot(point->direction) * point->direction;
  if (step.norm() > kLongestStep) step *= kLongestStep / step.norm();
  point->position += step;
  point->lag -= (lag_gradient + by_lag_.dot(step)) / lag_information;
}

}  // namespace evit
