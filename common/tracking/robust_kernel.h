#pragma once

namespace evit {

/// Robust kernel rho(s) of a squared, whitened residual s; rho(0) = 0, rho'(0) = 1, concave. The formulas are
/// in kernel_lanes.h.
struct RobustKernel {
  enum class Kind { kHuber, kCauchy, kGemanMcClure };
  Kind kind = Kind::kCauchy;
  double scale = 1;  // in units of the whitened residual
};

}  // namespace evit
