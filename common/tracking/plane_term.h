#pragma once

#include <Eigen/Core>

#include "common/tracking/event_alignment.h"

namespace evit {

/// What one point adds to the alignment term's cost, as a function of where it lies on the image: exact
/// gradient and curvature of rho(r^2) / 2 (AlignmentTerm keeps the curvature's positive part alone). Per
/// pixel and squared pixel of level 0.
struct PlaneTerm {
  Eigen::Vector2d pixel;
  Eigen::Vector2d gradient;
  Eigen::Matrix2d curvature;
};

/// Of the field's value at `pixel`.
PlaneTerm PlaneTermAt(const AlignmentSettings& settings, const SurfaceField& field,
                      const Eigen::Vector2d& pixel);

}  // namespace evit
