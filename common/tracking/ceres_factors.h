#pragma once

#include <ceres/sized_cost_function.h>

#include <array>
#include <optional>

#include "common/tracking/event_alignment.h"
#include "common/tracking/imu_term.h"
#include "common/tracking/prior.h"
#include "common/tracking/state_matrices.h"

/// The terms of the objective as Ceres cost functions. Pose blocks have 7 numbers and PoseManifold.
namespace evit {

/// All points of one keyframe as ONE residual block of seven rows instead of one block per point. With the
/// Gauss-Newton system H, g of the robust sum and H = L L^T, the rows are r = L^-1 g and J = L^T, so that J^T
/// J = H and J^T r = g; the seventh row is constant and makes |r|^2 / 2 the exact robust cost (concave
/// kernels leave it real). Ceres thus takes the same steps as with a thousand blocks, at a hundredth of the
/// book-keeping.
class EventAlignmentFactor : public ceres::SizedCostFunction<7, 7> {
 public:
  /// All arguments must outlive this.
  EventAlignmentFactor(const AlignmentSettings* settings, const SurfaceField* field, int level,
                       const AlignmentPoints* points)
      : settings_(settings), field_(field), level_(level), points_(points) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const AlignmentTerm& TermAt(const double* pose) const;

  const AlignmentSettings* settings_;
  const SurfaceField* field_;
  int level_;
  const AlignmentPoints* points_;
  // Ceres asks for the cost of a step, then, of most, for the derivatives at the same pose: both are
  // evaluated once.
  mutable std::optional<std::array<double, 7>> evaluated_at_;
  mutable AlignmentTerm term_;
};

/// ImuTerm over (pose i, motion i, pose j, motion j).
class ImuFactor : public ceres::SizedCostFunction<15, 7, 9, 7, 9> {
 public:
  explicit ImuFactor(ImuTerm term) : term_(std::move(term)) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ImuTerm term_;
};

/// StatePrior over (pose, motion).
class PriorFactor : public ceres::SizedCostFunction<15, 7, 9> {
 public:
  explicit PriorFactor(const StatePrior& prior) : mean_(prior.mean), root_(SquareRoot(prior.information)) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  BodyState mean_;
  Matrix15d root_;
};

}  // namespace evit
