#include "common/calibration/overlap_calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/calibration/overlap_cost.h"
#include "common/geometry/degrees.h"

namespace evit {
namespace {

using Vector = OverlapCost::Vector;
using Matrix = OverlapCost::Matrix;

constexpr std::size_t kFewestViews = 10;
constexpr std::int64_t kFewestEvents = 200;  // pixels that fired in a view: fewer say nothing
constexpr std::size_t kStretches = 12;       // of the recording, for the spread of the gradient
constexpr int kMaxIterations = 30;
constexpr double kConverged = 1e-5;                       // m, rad, s
constexpr double kMostTurn = 0.007, kMostOffset = 0.002;  // rad, s: beyond, not observable
constexpr double kMinKappa = 0.05;  // of the overlap found, beyond chance; a wrong map has 0

constexpr double kHoldInformation = 1e12;  // information: a micrometre, a microsecond
constexpr std::size_t kSearchViews = 30;   // of the search, spread over the recording

// Standard deviations of the rig file's translation, m: those that it states, or the option's.
Eigen::Vector3d PositionSigma(const Rig& rig, const OverlapCalibrationOptions& o) {
  return rig.T_body_camera_sigma.translation.unaryExpr(
      [&o](double stated) { return stated > 0 ? stated : o.position_sigma; });
}

Matrix PriorInformation(const Rig& rig, const OverlapCalibrationOptions& o) {
  Vector sigma;
  sigma << PositionSigma(rig, o), Eigen::Vector3d::Ones(), o.offset_sigma, o.lag_sigma;
  return sigma.array().square().inverse().matrix().asDiagonal();
}

// From the rig file's figures, as a tangent vector.
Vector Moved(const OverlapCost::Values& from, const OverlapCost::Values& to) {
  Vector d;
  d << to.T_body_camera.p - from.T_body_camera.p,
      LogSO3(from.T_body_camera.q.conjugate() * to.T_body_camera.q), to.offset - from.offset,
      to.lag_px - from.lag_px;
  return d;
}

// The best turn of a grid around the rig file's, as fine as the blur.
OverlapCost::Values Search(const OverlapCost& cost, const OverlapCost::Values& from, double range,
                           double step, std::size_t every, const std::function<void()>& between_steps) {
  OverlapCost::Values best = from;
  double least = cost.Sparse(from, every);
  const int n = static_cast<int>(std::ceil(range / step));
  for (int x = -n; x <= n; ++x) {
    for (int y = -n; y <= n; ++y) {
      if (between_steps) between_steps();
      for (int z = -n; z <= n; ++z) {
        OverlapCost::Values tried = from;
        tried.T_body_camera.q = tried.T_body_camera.q * ExpSO3(range / n * Eigen::Vector3d(x, y, z));
        const double there = cost.Sparse(tried, every);
        if (there < least) least = there, best = tried;
      }
    }
  }
  return best;
}

// What errs alike in all views.
OverlapCalibration::Covariance Common(const std::vector<MapView>& views, const Camera& camera,
                                      const OverlapCalibrationOptions& options) {
  double speed2 = 0;
  for (const MapView& view : views)
    speed2 += view.speed_px * view.speed_px / static_cast<double>(views.size());
  const double turn = options.registration_px / camera.fx,
               late2 = std::pow(options.registration_px, 2) / (speed2 + 1);
  Eigen::Matrix<double, 7, 1> variances;
  variances << Eigen::Vector3d::Constant(std::pow(options.position_sigma, 2)),
      Eigen::Vector3d::Constant(turn * turn), late2;
  return variances.asDiagonal();
}

struct Problem {
  const OverlapCost& cost;
  const OverlapCost::Values& rig;
  const Matrix& prior;
  double scale;  // of the cost: from grey levels to something like a log-likelihood
  const std::function<void()>& between_steps;

  OverlapCost::Term At(const OverlapCost::Values& values) const {
    OverlapCost::Term term = cost.Total(values);
    const Vector d = Moved(rig, values);
    term.cost = scale * term.cost + 0.5 * d.dot(prior * d);
    term.gradient = scale * term.gradient + prior * d;
    term.hessian = scale * term.hessian + prior;
    return term;
  }
};

// Levenberg and Marquardt's steps.
void Minimise(const Problem& problem, OverlapCost::Values* values) {
  double lambda = 1e-3;
  OverlapCost::Term term = problem.At(*values);
  for (int k = 0; k < kMaxIterations; ++k) {
    if (problem.between_steps) problem.between_steps();
    Matrix H = term.hessian;
    H.diagonal() *= 1 + lambda;
    const Vector step = -H.ldlt().solve(term.gradient);
    const OverlapCost::Values tried = values->Plus(step);
    const OverlapCost::Term there = problem.At(tried);
    if (there.cost < term.cost) {
      *values = tried;
      term = there;
      lambda = std::max(1e-6, lambda / 5);
      if (step.cwiseAbs().maxCoeff() < kConverged) return;
    } else {
      lambda *= 10;
      if (lambda > 1e6) return;
    }
  }
}

// Sum over stretches of g g', each the gradient of a piece of the recording. The whole's is zero at the
// minimum (but for the prior's), so that of the stretches spreads around it.
Matrix Spread(const OverlapCost& cost, const OverlapCost::Values& values) {
  const std::vector<OverlapCost::Term> terms = cost.Each(values);
  const std::size_t n = std::min(kStretches, terms.size());
  std::vector<Vector> sums(n, Vector::Zero());
  for (std::size_t k = 0; k < terms.size(); ++k) sums[k * n / terms.size()] += terms[k].gradient;
  Vector mean = Vector::Zero();
  for (const Vector& g : sums) mean += g / static_cast<double>(n);
  Matrix spread = Matrix::Zero();
  for (const Vector& g : sums) spread += (g - mean) * (g - mean).transpose();
  return spread * static_cast<double>(n) / static_cast<double>(n - 1);
}

OverlapCalibration Failed(const char* reason) {
  OverlapCalibration result;
  result.reason = reason;
  return result;
}

// Adds what holds the rig file's figures, and names them; whether the offset is among them.
bool HoldUnobservable(const OverlapCalibration::Covariance& P, Matrix* prior,
                      std::vector<Unobservable>* out) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(P.block<3, 3>(3, 3));
  for (int k = 2; k >= 0; --k) {
    const double sigma = std::sqrt(std::max(0.0, axes.eigenvalues()[k]));
    if (sigma <= kMostTurn) continue;
    const Eigen::Vector3d axis = axes.eigenvectors().col(k);
    out->push_back({Unobservable::Value::kRotation, axis, sigma});
    prior->block<3, 3>(3, 3) += kHoldInformation * axis * axis.transpose();
  }
  if (const double sigma = std::sqrt(P(6, 6)); sigma > kMostOffset) {
    out->push_back({Unobservable::Value::kTimeOffset, Eigen::Vector3d::Zero(), sigma});
    (*prior)(6, 6) += kHoldInformation;
    return true;
  }
  return false;
}

}  // namespace

OverlapCalibration CalibrateByOverlap(const std::vector<MapView>& all, const Trajectory& body, const Rig& rig,
                                      const OverlapCalibrationOptions& options) {
  std::vector<MapView> views;
  for (const MapView& view : all) {
    if (view.fired.size() >= kFewestEvents) views.push_back(view);
  }
  if (views.size() < kFewestViews)
    return Failed("fewer than ten views of the map have events: do log, truth and map belong together?");

  const OverlapCost::Values before{rig.T_body_camera, ToSeconds(rig.camera_time_offset), options.lag_px};
  const Matrix prior_all = PriorInformation(rig, options);
  Matrix prior = prior_all;
  for (const int held : {0, 1, 2, 6, 7})
    prior(held, held) = kHoldInformation;  // while it is far from the minimum
  const double coarse = 2 * options.blur_px;
  OverlapCost::Values values;
  {
    const OverlapCost cost(&views, &body, rig.camera, coarse);
    values = Search(cost, before, options.search_deg / kDegreesPerRadian, 1.5 * coarse / rig.camera.fx,
                    std::max<std::size_t>(1, views.size() / kSearchViews), options.between_steps);
    Minimise({cost, before, prior, 1, options.between_steps}, &values);
  }
  OverlapCalibration result;
  const OverlapCost cost(&views, &body, rig.camera, options.blur_px);
  Minimise({cost, before, prior, 1, options.between_steps}, &values);
  prior = prior_all;
  // The weight of the cost against the prior: so that curvature and spread say the same of rotation.
  double scale = 1;
  for (int k = 0; k < 3; ++k) {
    Minimise({cost, before, prior, scale, options.between_steps}, &values);
    const Matrix H = cost.Total(values).hessian, S = Spread(cost, values);
    scale = 3 / (H.block<3, 3>(3, 3).ldlt().solve(S.block<3, 3>(3, 3))).trace();
    const Matrix A = (scale * H + prior).inverse();
    result.covariance = (A * (scale * scale * S + prior) * A).topLeftCorner<7, 7>();
  }
  result.covariance += Common(views, rig.camera, options);
  const bool offset_held = HoldUnobservable(result.covariance, &prior, &result.unobservable);
  if (!result.unobservable.empty()) Minimise({cost, before, prior, scale, options.between_steps}, &values);

  result.T_body_camera = values.T_body_camera;
  result.offset = offset_held ? rig.camera_time_offset : std::llround(1e6 * values.offset);
  result.before = cost.Overlap(before);
  result.after = cost.Overlap(values);
  if (result.after.kappa() < kMinKappa || result.after.kappa() < result.before.kappa()) {
    result.reason =
        "the map does not come to lie on the events: do log, truth, map and rig belong together, in one "
        "frame and one clock?";
    return result;
  }
  result.success = true;
  return result;
}

}  // namespace evit
