#pragma once

#include "common/tracking/alignment_points.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/kernel_lanes.h"
#include "common/tracking/surface_lanes.h"

namespace evit {

/// From where a batch of points is seen, made ready for lanes.
struct BatchView {
  BatchView(const AlignmentSettings& settings, const AlignmentPoints& points, const SE3& T_map_body);

  LaneCamera camera;
  bool fisheye;
  float width, height;     // pixels
  float R_bw[9], t_wb[3];  // body from map (row-major); body in the map, relative to the points' origin
  float R_cb[9], t_cb[3];  // camera from body
};

/// The event alignment term for a whole batch of points, a block of lanes at a time: what each block needs to
/// know. The same written plainly is reference_alignment.h.
struct BatchAlignment : BatchView {
  BatchAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                 const AlignmentPoints& points, const SE3& T_map_body);

  LaneField field;
  float inverse_sigma;  // 1 / grey levels
  LaneKernel kernel;
};

/// Sums over blocks of points: cost, and gradient and Hessian (upper triangle, row by row) over (position in
/// the body frame, rotation), each kept by lane so that the order of additions is the same on every machine.
struct AlignmentSums {
  double rho = 0;
  alignas(64) float gradient[6][kLanes] = {};
  alignas(64) float hessian[21][kLanes] = {};
};

/// What of it: the cost alone; gradient and Hessian too, the Hessian from each point's positive curvature
/// alone (AlignmentTerm); or from all of it, signs and all.
enum class AlignmentPart { kCost, kSafe, kExact };
void SumAlignment(const BatchAlignment& batch, const PointArrays& points, AlignmentPart part,
                  AlignmentSums* sums);

/// Sum over the lanes, in their order.
double SumLanes(const float* lanes);
/// A Hessian over the tangent (dp, dtheta) of T_map_body from the upper triangle of such sums.
Matrix6d HessianOfLanes(const float (*upper)[kLanes], const SE3& T_map_body);

}  // namespace evit
