#include "common/tracking/event_alignment.h"

#include <algorithm>
#include <cmath>

namespace evit {

void RobustKernel::Evaluate(double s, double* rho, double* slope) const {
  const double c2 = scale * scale;
  switch (kind) {
    case Kind::kHuber:
      if (s <= c2) {
        *rho = s;
        *slope = 1;
      } else {
        const double r = std::sqrt(s);
        *rho = 2 * scale * r - c2;
        *slope = scale / r;
      }
      return;
    case Kind::kCauchy:
      *rho = c2 * std::log1p(s / c2);
      *slope = c2 / (c2 + s);
      return;
    case Kind::kGemanMcClure: {
      const double w = c2 / (c2 + s);
      *rho = s * w;
      *slope = w * w;
      return;
    }
  }
}

namespace {

// Sums rho over many residuals. For Cauchy's kernel the logarithms of sixteen terms are taken as one of their
// product: the sum is the same, and the logarithm was a sixth of a solve.
class KernelSum {
 public:
  explicit KernelSum(const RobustKernel& kernel)
      : kernel_(kernel), inverse_(1 / (kernel.scale * kernel.scale)) {}
  /// Adds rho(s) and returns rho'(s).
  double Add(double s) {
    if (kernel_.kind != RobustKernel::Kind::kCauchy) {
      double rho = 0, slope = 0;
      kernel_.Evaluate(s, &rho, &slope);
      sum_ += rho;
      return slope;
    }
    const double term = 1 + s * inverse_;
    product_ *= term;
    if (++count_ == 16) Fold();
    return 1 / term;
  }
  double Total() {
    Fold();
    return sum_;
  }

 private:
  void Fold() {
    if (count_ > 0) sum_ += std::log(product_) / inverse_;
    product_ = 1;
    count_ = 0;
  }
  const RobustKernel& kernel_;
  double inverse_, sum_ = 0, product_ = 1;
  int count_ = 0;
};

// U with U^T U = g g^T + w [H]+, for the surface's gradient g and second derivatives H.
Eigen::Matrix2d CurvatureRoot(const Eigen::Vector2d& g, double w, const SurfaceField::Sample& s) {
  const double mean = 0.5 * (s.hxx + s.hyy), half = 0.5 * (s.hxx - s.hyy);
  const double spread = std::sqrt(half * half + s.hxy * s.hxy);
  const double high = std::max(mean + spread, 0.0),
               low = std::max(mean - spread, 0.0);  // eigenvalues, clamped
  Eigen::Matrix2d m = g * g.transpose();
  if (spread > 1e-12) {
    const double k = 0.5 * (high - low) / spread, c = 0.5 * (high + low);
    m(0, 0) += w * (c + k * half);
    m(1, 1) += w * (c - k * half);
    m(0, 1) += w * k * s.hxy;
    m(1, 0) += w * k * s.hxy;
  } else {
    m.diagonal().array() += w * high;
  }
  Eigen::Matrix2d root = Eigen::Matrix2d::Zero();  // Cholesky, upper triangular; m may be singular
  root(0, 0) = std::sqrt(m(0, 0));
  if (root(0, 0) > 1e-12) root(0, 1) = m(0, 1) / root(0, 0);
  root(1, 1) = std::sqrt(std::max(0.0, m(1, 1) - root(0, 1) * root(0, 1)));
  return root;
}

}  // namespace

AlignmentTerm EvaluateAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                                const std::vector<Eigen::Vector3f>& points, const SE3& T_world_body,
                                bool derivatives) {
  const Eigen::Matrix3d R_wb = T_world_body.R(), R_cb = settings.T_camera_body.R();
  const Eigen::Vector3d& t_cb = settings.T_camera_body.p;
  const double inv_sigma = 1.0 / settings.image_sigma;

  AlignmentTerm term;
  KernelSum kernel(settings.kernel);
  // Accumulated in the body frame, where the Jacobian of a residual is (-h, h x P_body); the position rows
  // are turned into the world frame once at the end.
  Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 2, 3> d_pixel;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p_body = R_wb.transpose() * (point.cast<double>() - T_world_body.p);
    const Eigen::Vector3d p_camera = R_cb * p_body + t_cb;
    Eigen::Vector2d pixel;
    if (!settings.camera.Project(p_camera, &pixel, derivatives ? &d_pixel : nullptr)) {
      const double r = 255.0 * inv_sigma;
      kernel.Add(r * r);
      continue;
    }
    if (!derivatives) {
      const double r = field.ValueAt(level, pixel.x(), pixel.y()) * inv_sigma;
      kernel.Add(r * r);
      continue;
    }
    const SurfaceField::Sample s = field.At(level, pixel.x(), pixel.y());
    const double r = s.value * inv_sigma;
    const double slope = kernel.Add(r * r);
    if (s.gx == 0 && s.gy == 0) continue;
    Eigen::Matrix<double, 2, 6> J;  // d(pixel)/d(tangent), position in the body frame
    J.leftCols<3>() = -d_pixel * R_cb;
    J.row(0).tail<3>() = p_body.cross(J.row(0).head<3>().transpose());
    J.row(1).tail<3>() = p_body.cross(J.row(1).head<3>().transpose());
    const Eigen::Vector2d g(inv_sigma * s.gx, inv_sigma * s.gy);
    gradient.noalias() += (slope * r) * J.transpose() * g;
    const Eigen::Matrix2d root = CurvatureRoot(g, r * inv_sigma, s);
    const Eigen::Matrix<double, 2, 6> rows = std::sqrt(slope) * root * J;
    hessian.noalias() += rows.transpose() * rows;
  }
  term.cost = 0.5 * kernel.Total();
  if (derivatives) {
    Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Identity();
    turn.topLeftCorner<3, 3>() = R_wb;
    term.hessian = turn * hessian * turn.transpose();
    term.gradient = turn * gradient;
  }
  return term;
}

AlignmentQuality MeasureAlignment(const AlignmentSettings& settings, const SurfaceField& field,
                                  const std::vector<Eigen::Vector3f>& points, const SE3& T_world_body,
                                  double shift) {
  const SE3 T_camera_world = settings.T_camera_body * T_world_body.Inverse();
  AlignmentQuality quality;
  double sum = 0, shifted = 0;
  int inliers = 0;
  for (const Eigen::Vector3f& point : points) {
    Eigen::Vector2d pixel;
    if (!settings.camera.Project(T_camera_world * point.cast<double>(), &pixel) ||
        !settings.camera.Contains(pixel)) {
      continue;
    }
    ++quality.n_points;
    const double value = field.ValueAt(0, pixel.x(), pixel.y());
    sum += value;
    inliers += value < 127.5 ? 1 : 0;
    shifted +=
        0.25 *
        (field.ValueAt(0, pixel.x() + shift, pixel.y()) + field.ValueAt(0, pixel.x() - shift, pixel.y()) +
         field.ValueAt(0, pixel.x(), pixel.y() + shift) + field.ValueAt(0, pixel.x(), pixel.y() - shift));
  }
  if (quality.n_points > 0) {
    quality.mean_value = sum / quality.n_points;
    quality.shifted_value = shifted / quality.n_points;
    quality.inlier_share = static_cast<double>(inliers) / quality.n_points;
  }
  return quality;
}

}  // namespace evit
