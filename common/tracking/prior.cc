#include "common/tracking/prior.h"

#include "common/tracking/state_matrices.h"

namespace evit {
namespace {

// Rotation part of Minus() differs from a straight difference by this; ignoring it would bend the prior at
// large moves.
Matrix15d MinusJacobian(const Vector15d& d) {
  Matrix15d m = Matrix15d::Identity();
  m.block<3, 3>(3, 3) = RightJacobianInverseSO3(d.segment<3>(3));
  return m;
}

}  // namespace

PriorTerm EvaluatePrior(const StatePrior& prior, const BodyState& state) {
  const Vector15d d = Minus(state, prior.mean);
  const Matrix15d J = MinusJacobian(d), weighted = J.transpose() * prior.information;
  const Vector15d gradient = weighted * d;
  return {0.5 * d.dot(prior.information * d), gradient, weighted * J};
}

StatePrior Marginalize(const StatePrior& prior, const AlignmentTerm& alignment, const KeyframeLink& link,
                       const BodyState& i, const BodyState& j) {
  const KeyframeLink::Term joined = link.Evaluate(i, j);
  const PriorTerm known = EvaluatePrior(prior, i);

  Matrix15d Hii = known.hessian + joined.hessian_ii;
  Hii.topLeftCorner<6, 6>() += alignment.hessian;
  Vector15d gi = known.gradient + joined.gradient_i;
  gi.head<6>() += alignment.gradient;
  const Matrix15d& Hij = joined.hessian_ij;

  StatePrior next;
  next.information = joined.hessian_jj - Hij.transpose() * Solve(Hii, Hij);
  next.information = 0.5 * (next.information + next.information.transpose()).eval();
  const Vector15d g = joined.gradient_j - Hij.transpose() * Solve(Hii, gi);
  // The Gaussian's mean is where its gradient vanishes. A small ridge keeps unobserved directions where they
  // are.
  const Matrix15d ridge = 1e-9 * Matrix15d(next.information.diagonal().cwiseMax(1e-12).asDiagonal());
  const Vector15d step = -Solve(Matrix15d(next.information + ridge), g);
  next.mean = Plus(j, step);
  return next;
}

}  // namespace evit
