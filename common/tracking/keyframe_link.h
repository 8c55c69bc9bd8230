#pragma once

#include <optional>

#include "common/tracking/imu_term.h"
#include "common/tracking/standstill_term.h"

namespace evit {

/// All that joins two neighbouring keyframes i and j of a window: the IMU's term and, where the body stood
/// still, that it did.
class KeyframeLink {
 public:
  explicit KeyframeLink(const ImuTerm& imu, const std::optional<StandstillTerm>& standstill = {})
      : imu_(imu), standstill_(standstill) {}

  /// Its part of the normal equations over the tangents of i and j.
  struct Term {
    double cost;
    Vector15d gradient_i, gradient_j;
    Matrix15d hessian_ii, hessian_ij, hessian_jj;
  };
  Term Evaluate(const BodyState& i, const BodyState& j) const;

 private:
  ImuTerm imu_;
  std::optional<StandstillTerm> standstill_;
};

}  // namespace evit
