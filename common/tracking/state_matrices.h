#pragma once

#include "common/tracking/state.h"

/// Decompositions of matrices over a whole state's tangent. They are compiled here alone: each takes the
/// compiler some seconds.
namespace evit {

/// X with A X = B, for a symmetric positive semi-definite A (LDL^T).
Matrix15d Solve(const Matrix15d& A, const Matrix15d& B);
Vector15d Solve(const Matrix15d& A, const Vector15d& b);

/// A square root R of a symmetric positive semi-definite matrix, R^T R = m. Not triangular: it comes from the
/// eigenvectors, and stays finite where m lacks rank.
Matrix15d SquareRoot(const Matrix15d& m);

}  // namespace evit
