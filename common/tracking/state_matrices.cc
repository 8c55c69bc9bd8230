#include "common/tracking/state_matrices.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace evit {

Matrix15d Solve(const Matrix15d& A, const Matrix15d& B) { return A.ldlt().solve(B); }

Vector15d Solve(const Matrix15d& A, const Vector15d& b) { return A.ldlt().solve(b); }

Matrix15d SquareRoot(const Matrix15d& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix15d> solver(m);
  return solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace evit
