#pragma once

#include "common/tracking/batch_alignment.h"

/// What all loops over the points of a BatchView begin with, a block of lanes at a time: where the points
/// show, and how that changes with the pose.
namespace evit {

/// Points in the body frame and on the image.
struct BodyLanes {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
  alignas(64) float mx[kLanes], my[kLanes], inverse_z[kLanes];
  alignas(64) float dxx[kLanes], dxy[kLanes], dyy[kLanes];
  alignas(64) float u[kLanes], v[kLanes];
  alignas(64) float ahead[kLanes];  // 1, or 0 where the lens does not see the point
};

/// `x`, `y`, `z`: of AlignmentPoints::local().
template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void ProjectLanes(const BatchView& c, const float* x, const float* y, const float* z,
                                     BodyLanes* out) {
  const float* const B = c.R_bw;
  const float* const C = c.R_cb;
  for (int l = 0; l < kLanes; ++l) {
    const float dx = x[l] - c.t_wb[0], dy = y[l] - c.t_wb[1], dz = z[l] - c.t_wb[2];
    const float bx = B[0] * dx + B[1] * dy + B[2] * dz;
    const float by = B[3] * dx + B[4] * dy + B[5] * dz;
    const float bz = B[6] * dx + B[7] * dy + B[8] * dz;
    const float px = C[0] * bx + C[1] * by + C[2] * bz + c.t_cb[0];
    const float py = C[3] * bx + C[4] * by + C[5] * bz + c.t_cb[1];
    const float pz = C[6] * bx + C[7] * by + C[8] * bz + c.t_cb[2];
    // Masks are numbers, not booleans: the compiler makes vectors of these.
    const float inverse = 1 / (pz > 1e-6F ? pz : 1e-6F);
    const float mx = px * inverse, my = py * inverse;
    const float ahead =
        (pz > 1e-6F ? 1.0F : 0.0F) * (mx * mx + my * my <= c.camera.max_radius2 ? 1.0F : 0.0F);
    const float sx = ahead * mx, sy = ahead * my;  // in range, so that they can become an index
    const LaneDistortion d = DistortLane<kModel>(c.camera, sx, sy);
    out->x[l] = bx, out->y[l] = by, out->z[l] = bz;
    out->mx[l] = sx, out->my[l] = sy, out->inverse_z[l] = inverse;
    out->dxx[l] = d.dxx, out->dxy[l] = d.dxy, out->dyy[l] = d.dyy;
    out->u[l] = c.camera.fx * d.x + c.camera.cx;
    out->v[l] = c.camera.fy * d.y + c.camera.cy;
    out->ahead[l] = ahead;
  }
}

/// J: d(pixel coordinate)/d(position in the body frame, rotation), six arrays of lanes, from the coordinate's
/// derivative (d0, d1) over the normalised plane.
EVIT_ALWAYS_INLINE void JacobianLanes(const BatchView& c, const BodyLanes& p, const float* d0,
                                      const float* d1, float focal, float (*J)[kLanes]) {
  const float* const C = c.R_cb;
  for (int l = 0; l < kLanes; ++l) {
    const float scale = focal * p.inverse_z[l];
    const float a = scale * d0[l], b = scale * d1[l], d = -(a * p.mx[l] + b * p.my[l]);
    const float jx = -(a * C[0] + b * C[3] + d * C[6]);
    const float jy = -(a * C[1] + b * C[4] + d * C[7]);
    const float jz = -(a * C[2] + b * C[5] + d * C[8]);
    J[0][l] = jx, J[1][l] = jy, J[2][l] = jz;
    J[3][l] = p.y[l] * jz - p.z[l] * jy;  // p_body x j
    J[4][l] = p.z[l] * jx - p.x[l] * jz;
    J[5][l] = p.x[l] * jy - p.y[l] * jx;
  }
}

/// 1 where a point lies in the image, `border` pixels inside or more, else 0.
EVIT_ALWAYS_INLINE void InsideLanes(const BatchView& c, const BodyLanes& p, float border, float* inside) {
  for (int l = 0; l < kLanes; ++l) {
    inside[l] = p.ahead[l] * (p.u[l] >= border ? 1.0F : 0.0F) * (p.v[l] >= border ? 1.0F : 0.0F) *
                (p.u[l] <= c.width - 1 - border ? 1.0F : 0.0F) *
                (p.v[l] <= c.height - 1 - border ? 1.0F : 0.0F);
  }
}

}  // namespace evit
