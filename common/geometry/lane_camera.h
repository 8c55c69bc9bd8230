#pragma once

#include <cmath>

#include "common/geometry/camera.h"
#include "common/simd/lanes.h"

namespace evit {

/// A Camera made ready for lanes.
struct LaneCamera {
  LaneCamera() = default;
  explicit LaneCamera(const Camera& camera);

  float fx = 0, fy = 0, cx = 0, cy = 0;
  float k[5] = {};        // distortion, as in Camera
  float max_radius2 = 0;  // squared radius of the normalised plane up to which the lens model holds
};

/// One lane's projection: distorted normalised coordinates, and d(out)/d(in), which is symmetric.
struct LaneDistortion {
  float x, y, dxx, dxy, dyy;
};

/// atan(r) for r >= 0, to single precision.
EVIT_ALWAYS_INLINE float LaneAtan(float r) {
  // Reduced to |a| <= tan(pi/8) by the angle pi/4, after the reciprocal beyond 1.
  const bool beyond = r > 1;
  const float b = beyond ? 1 / r : r;
  const bool upper = b > 0.41421356F;
  const float a = upper ? (b - 1) / (b + 1) : b;
  const float z = a * a;
  float p = (((8.05374449538e-2F * z - 1.38776856032e-1F) * z + 1.99777106478e-1F) * z - 3.33329491539e-1F) *
                z * a +
            a;
  p = upper ? p + 0.78539816F : p;
  return beyond ? 1.57079633F - p : p;
}

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE LaneDistortion DistortLane(const LaneCamera& c, float x, float y) {
  const float xx = x * x, yy = y * y, xy = x * y, r2 = xx + yy;
  if (kModel == Camera::Model::kPlumbBob) {
    const float radial = 1 + r2 * (c.k[0] + r2 * (c.k[1] + r2 * c.k[4]));
    const float slope = 2 * (c.k[0] + r2 * (2 * c.k[1] + r2 * 3 * c.k[4]));
    const float p1 = c.k[2], p2 = c.k[3];
    return {x * radial + 2 * p1 * xy + p2 * (r2 + 2 * xx), y * radial + p1 * (r2 + 2 * yy) + 2 * p2 * xy,
            radial + xx * slope + 2 * p1 * y + 6 * p2 * x, xy * slope + 2 * (p1 * x + p2 * y),
            radial + yy * slope + 6 * p1 * y + 2 * p2 * x};
  }
  const float safe2 = r2 > 1e-10F ? r2 : 1e-10F;
  const float r = std::sqrt(safe2), theta = LaneAtan(r), t2 = theta * theta;
  const float poly = 1 + t2 * (c.k[0] + t2 * (c.k[1] + t2 * (c.k[2] + t2 * c.k[3])));
  const float slope = 1 + t2 * (3 * c.k[0] + t2 * (5 * c.k[1] + t2 * (7 * c.k[2] + t2 * 9 * c.k[3])));
  const float scale = theta * poly / r;
  const float d_scale = (slope / (1 + safe2) - scale) / safe2;  // d(scale)/dr / r
  return {scale * x, scale * y, scale + d_scale * xx, d_scale * xy, scale + d_scale * yy};
}

}  // namespace evit
