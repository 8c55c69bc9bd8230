#include "common/tracking/reference_alignment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace evit {
namespace {

struct Sample {
  double value;
  Eigen::Vector2d gradient;
  Eigen::Matrix2d hessian;
};

// The quadratic B-spline over the pixels. Outside the image the nearest border counts, and nothing pulls
// across.
Sample Interpolate(const cv::Mat& image, const Eigen::Vector2d& at) {
  const double x = std::clamp(at.x(), 1.0, image.cols - 3.0), y = std::clamp(at.y(), 1.0, image.rows - 2.0);
  const int i = static_cast<int>(std::floor(x + 0.5)), j = static_cast<int>(std::floor(y + 0.5));
  const auto weights = [](double a) {
    return Eigen::Vector3d((0.5 - a) * (0.5 - a) / 2, 0.75 - a * a, (0.5 + a) * (0.5 + a) / 2);
  };
  const auto slopes = [](double a) { return Eigen::Vector3d(a - 0.5, -2 * a, a + 0.5); };
  const Eigen::Vector3d wx = weights(x - i), wy = weights(y - j), dx = slopes(x - i), dy = slopes(y - j),
                        dd(1, -2, 1);
  Eigen::Matrix3d taps;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) taps(r, c) = image.at<std::uint8_t>(j - 1 + r, i - 1 + c);
  const double in_x = x == at.x() ? 1 : 0, in_y = y == at.y() ? 1 : 0;
  Sample s;
  s.value = wy.dot(taps * wx);
  s.gradient << in_x * wy.dot(taps * dx), in_y * dy.dot(taps * wx);
  s.hessian(0, 0) = in_x * wy.dot(taps * dd);
  s.hessian(0, 1) = s.hessian(1, 0) = in_x * in_y * dy.dot(taps * dx);
  s.hessian(1, 1) = in_y * dd.dot(taps * wx);
  return s;
}

}  // namespace

KernelValue ReferenceKernel(const RobustKernel& kernel, double s) {
  const double c = kernel.scale, c2 = c * c;
  switch (kernel.kind) {
    case RobustKernel::Kind::kHuber:
      return s <= c2 ? KernelValue{s, 1} : KernelValue{2 * c * std::sqrt(s) - c2, c / std::sqrt(s)};
    case RobustKernel::Kind::kCauchy:
      return {c2 * std::log1p(s / c2), c2 / (c2 + s)};
    case RobustKernel::Kind::kGemanMcClure:
      return {s * c2 / (c2 + s), c2 / (c2 + s) * (c2 / (c2 + s))};
  }
  return {0, 0};
}

AlignmentTerm ReferenceAlignment(const AlignmentSettings& settings, const cv::Mat& surface, int level,
                                 const std::vector<Eigen::Vector3d>& points, const SE3& T_map_body) {
  const double scale = std::ldexp(1.0, -level), sigma = settings.image_sigma;
  AlignmentTerm term;
  for (const Eigen::Vector3d& P : points) {
    // pi(T_camera_map P): where the point projects to, and what it meets there.
    const Eigen::Vector3d p_body = T_map_body.Inverse() * P;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, 3> projection;
    const bool seen = settings.camera().Project(settings.T_camera_body * p_body, &pixel, &projection);
    const Sample field = Interpolate(surface, scale * pixel);
    // Eq. (3): rho(r^2) / 2. A point that is not seen costs what an empty surface costs, and does not pull.
    const double r = (seen ? field.value : 255) / sigma;
    const KernelValue kernel = ReferenceKernel(settings.kernel, r * r);
    term.cost += 0.5 * kernel.rho;
    if (!seen) continue;
    // The pixel over (dp, dtheta) of T_map_body: p_body = R^T (P - p).
    Eigen::Matrix<double, 3, 6> moved;
    moved << -T_map_body.R().transpose(), Hat(p_body);
    const Eigen::Matrix<double, 2, 6> J = projection * settings.T_camera_body.R() * moved;
    const Eigen::Vector2d g = scale / sigma * field.gradient;  // of r over the image
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> bend(scale * scale / sigma * r * field.hessian);
    const Eigen::Matrix2d positive =
        bend.eigenvectors() * bend.eigenvalues().cwiseMax(0).asDiagonal() * bend.eigenvectors().transpose();
    term.gradient += kernel.slope * r * J.transpose() * g;
    term.hessian += kernel.slope * J.transpose() * (g * g.transpose() + positive) * J;
  }
  return term;
}

}  // namespace evit
