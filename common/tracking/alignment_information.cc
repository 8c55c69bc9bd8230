#include "common/tracking/alignment_information.h"

#include <Eigen/Eigenvalues>

#include "common/tracking/plane_term.h"

namespace evit {
namespace {

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
    curvature += J.transpose() * PlaneTermAt(settings, field, pixel).curvature * J;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(curvature);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace evit
