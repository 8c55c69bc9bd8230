#include "common/tracking/alignment_information.h"

#include <Eigen/Eigenvalues>

#include "common/tracking/batch_samples.h"

namespace evit {

Matrix6d AlignmentInformation(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body) {
  CurvatureSums sums;
  SumCurvature(BatchAlignment(settings, field, 0, points, T_map_body), points.local(), &sums);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(HessianOfLanes(sums.hessian, T_map_body));
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace evit
