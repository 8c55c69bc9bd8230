#include "common/tracking/plane_term.h"

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

}  // namespace

PlaneTerm PlaneTermAt(const AlignmentSettings& settings, const SurfaceField& field,
                      const Eigen::Vector2d& pixel) {
  const SurfaceField::Sample f = field.At(0, pixel.x(), pixel.y());
  const double inverse_sigma = 1 / settings.image_sigma, r = f.value * inverse_sigma;
  const KernelSlopes slope = SlopesAt(settings.kernel, r * r);
  const Eigen::Vector2d g = inverse_sigma * Eigen::Vector2d(f.gx, f.gy);
  Eigen::Matrix2d curvature;
  curvature << f.hxx, f.hxy, f.hxy, f.hyy;
  PlaneTerm term;
  term.pixel = pixel;
  term.gradient = slope.first * r * g;
  term.curvature = (slope.first + 2 * slope.second * r * r) * g * g.transpose() +
                   slope.first * r * inverse_sigma * curvature;
  return term;
}

}  // namespace evit
