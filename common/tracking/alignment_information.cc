#include "common/tracking/alignment_information.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace evit {
namespace {

struct KernelSlopes {
  double first, second;  // rho' and rho'' at a squared residual
};

KernelSlopes SlopesAt(const RobustKernel& kernel, double s) {
  const double c2 = kernel.scale * kernel.scale;
  switch (kernel.kind) {
    case RobustKernel::Kind::kHuber:
      if (s <= c2) return {1, 0};
      return {kernel.scale / std::sqrt(s), -0.5 * kernel.scale / (s * std::sqrt(s))};
    case RobustKernel::Kind::kCauchy: {
      const double slope = c2 / (c2 + s);
      return {slope, -slope * slope / c2};
    }
    case RobustKernel::Kind::kGemanMcClure: {
      const double share = c2 / (c2 + s);
      return {share * share, -2 * share * share / (c2 + s)};
    }
  }
  return {1, 0};
}

// Of rho(r^2) / 2 over the image plane, where `f` is the field there.
Eigen::Matrix2d PlaneCurvature(const AlignmentSettings& settings, const SurfaceField::Sample& f) {
  const double inverse_sigma = 1 / settings.image_sigma, r = f.value * inverse_sigma;
  const KernelSlopes slope = SlopesAt(settings.kernel, r * r);
  const Eigen::Vector2d g = inverse_sigma * Eigen::Vector2d(f.gx, f.gy);
  Eigen::Matrix2d curvature;
  curvature << f.hxx, f.hxy, f.hxy, f.hyy;
  return (slope.first + 2 * slope.second * r * r) * g * g.transpose() +
         slope.first * r * inverse_sigma * curvature;
}

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Matrix6d AlignmentInformation(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body) {
  const Eigen::Matrix3d R_body_map = T_map_body.R().transpose(), R_camera_body = settings.T_camera_body.R();
  Matrix6d curvature = Matrix6d::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d p_body = R_body_map * (points.At(k) - T_map_body.p);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> projection;
    if (!settings.camera().Project(settings.T_camera_body * p_body, &pixel, &projection) ||
        !settings.camera().Contains(pixel)) {
      continue;
    }
    Eigen::Matrix<double, 2, 6> J;  // d(pixel)/d(dp, dtheta)
    J.leftCols<3>() = -projection * R_camera_body * R_body_map;
    J.rightCols<3>() = projection * R_camera_body * Cross(p_body);
    curvature += J.transpose() * PlaneCurvature(settings, field.At(0, pixel.x(), pixel.y())) * J;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(curvature);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace evit
