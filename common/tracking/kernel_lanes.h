#pragma once

#include <cmath>

#include "common/simd/lanes.h"
#include "common/tracking/robust_kernel.h"

namespace evit {

/// A RobustKernel made ready for lanes. CONTRIBUTING.md lists where a new kernel goes.
struct LaneKernel {
  explicit LaneKernel(const RobustKernel& kernel)
      : kind(kernel.kind),
        inverse_c2(static_cast<float>(1 / (kernel.scale * kernel.scale))),
        c(static_cast<float>(kernel.scale)) {}

  RobustKernel::Kind kind;
  float inverse_c2, c;
};

/// Writes rho' of the squared residuals s, and returns the sum of rho over the first n lanes.
EVIT_ALWAYS_INLINE double KernelLanes(const LaneKernel& kernel, const float* s, int n, float* slope) {
  alignas(64) float rho[kLanes];
  double sum = 0;
  const float c = kernel.c, c2 = c * c;
  switch (kernel.kind) {
    case RobustKernel::Kind::kCauchy: {
      // One logarithm for the product of all: the logarithm was a sixth of a solve.
      for (int l = 0; l < kLanes; ++l) {
        rho[l] = 1 + s[l] * kernel.inverse_c2;
        slope[l] = 1 / rho[l];
      }
      double product = 1;
      for (int l = 0; l < n; ++l) product *= static_cast<double>(rho[l]);
      sum = std::log(product) * static_cast<double>(c2);
      break;
    }
    case RobustKernel::Kind::kHuber:
      for (int l = 0; l < kLanes; ++l) {
        const float r = std::sqrt(s[l]);
        const bool inlier = r <= c;
        rho[l] = inlier ? s[l] : 2 * c * r - c2;
        slope[l] = inlier ? 1 : c / r;
      }
      for (int l = 0; l < n; ++l) sum += static_cast<double>(rho[l]);
      break;
    case RobustKernel::Kind::kGemanMcClure:
      for (int l = 0; l < kLanes; ++l) {
        const float w = c2 / (c2 + s[l]);
        rho[l] = s[l] * w;
        slope[l] = w * w;
      }
      for (int l = 0; l < n; ++l) sum += static_cast<double>(rho[l]);
      break;
  }
  return sum;
}

/// rho' and rho'' of the squared residuals s.
EVIT_ALWAYS_INLINE void KernelSlopeLanes(const LaneKernel& kernel, const float* s, float* first,
                                         float* second) {
  const float c = kernel.c, c2 = c * c;
  switch (kernel.kind) {
    case RobustKernel::Kind::kCauchy:
      for (int l = 0; l < kLanes; ++l) {
        first[l] = 1 / (1 + s[l] * kernel.inverse_c2);
        second[l] = -first[l] * first[l] * kernel.inverse_c2;
      }
      break;
    case RobustKernel::Kind::kHuber:
      for (int l = 0; l < kLanes; ++l) {
        const bool inlier = s[l] <= c2;
        const float safe = inlier ? 1 : s[l], root = std::sqrt(safe);
        first[l] = inlier ? 1 : c / root;
        second[l] = inlier ? 0 : -0.5F * c / (safe * root);
      }
      break;
    case RobustKernel::Kind::kGemanMcClure:
      for (int l = 0; l < kLanes; ++l) {
        const float share = c2 / (c2 + s[l]);
        first[l] = share * share;
        second[l] = -2 * share * share / (c2 + s[l]);
      }
      break;
  }
}

}  // namespace evit
