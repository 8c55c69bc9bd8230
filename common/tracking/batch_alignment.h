#pragma once

#include "common/tracking/alignment_points.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/kernel_lanes.h"
#include "common/tracking/surface_lanes.h"

namespace evit {

/// The event alignment term for a whole batch of points, a block of lanes at a time: what each block needs to
/// know. The same written plainly is reference_alignment.h.
struct BatchAlignment {
  BatchAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                 const AlignmentPoints& points, const SE3& T_map_body);

  LaneCamera camera;
  bool fisheye;
  LaneField field;
  float R_bw[9], t_wb[3];  // body from map (row-major); body in the map, relative to the points' origin
  float R_cb[9], t_cb[3];  // camera from body
  float inverse_sigma;     // 1 / grey levels
  LaneKernel kernel;
};

/// Sums over blocks of points: cost, and gradient and Hessian (upper triangle, row by row) over (position in
/// the body frame, rotation), each kept by lane so that the order of additions is the same on every machine.
struct AlignmentSums {
  double rho = 0;
  alignas(64) float gradient[6][kLanes] = {};
  alignas(64) float hessian[21][kLanes] = {};
};

void SumAlignment(const BatchAlignment& batch, const PointArrays& points, bool derivatives,
                  AlignmentSums* sums);

/// Values under points, and the mean of the four places `shift` pixels beside each. `inside`: 0 where a point
/// is not in the image. Arrays of points.size() rounded up to whole blocks.
void SampleBeside(const BatchAlignment& batch, const PointArrays& points, float width, float height,
                  float shift, float* value, float* beside, std::int32_t* inside);

}  // namespace evit
