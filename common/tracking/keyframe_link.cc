#include "common/tracking/keyframe_link.h"

namespace evit {

KeyframeLink::Term KeyframeLink::Evaluate(const BodyState& i, const BodyState& j) const {
  Matrix15d Ji, Jj;
  const Vector15d r = imu_.Evaluate(i, j, &Ji, &Jj);
  Term term{0.5 * r.squaredNorm(), Ji.transpose() * r,  Jj.transpose() * r,
            Ji.transpose() * Ji,   Ji.transpose() * Jj, Jj.transpose() * Jj};
  if (standstill_) {
    StandstillTerm::Jacobian Si, Sj;
    const StandstillTerm::Vector9d s = standstill_->Evaluate(i, j, &Si, &Sj);
    term.cost += 0.5 * s.squaredNorm();
    term.gradient_i += Si.transpose() * s;
    term.gradient_j += Sj.transpose() * s;
    term.hessian_ii += Si.transpose() * Si;
    term.hessian_ij += Si.transpose() * Sj;
    term.hessian_jj += Sj.transpose() * Sj;
  }
  return term;
}

}  // namespace evit
