#include "common/tracking/event_lag.h"

#include <algorithm>
#include <cmath>

#include "common/tracking/alignment_lanes.h"

namespace evit {
namespace {

constexpr float kSlow =
    5;  // pixels/s: well below it the direction of motion means nothing, and neither does a lag

struct LagBatch : BatchView {
  LagBatch(const BatchView& view, const SE3& T_map_body, const Eigen::Vector3d& velocity,
           const Eigen::Vector3d& rate, double lag_px)
      : BatchView(view), lag(static_cast<float>(lag_px)) {
    const Eigen::Vector3d v_body = T_map_body.R().transpose() * velocity;
    for (int k = 0; k < 3; ++k) {
      v[k] = static_cast<float>(v_body[k]);
      w[k] = static_cast<float>(rate[k]);
    }
  }
  float v[3], w[3];  // m/s, rad/s: of the body, in its frame
  float lag;         // pixels
};

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void MoveBack(const LagBatch& c, PointArrays* points) {
  const float* const B = c.R_bw;
  const float* const C = c.R_cb;
  for (std::size_t k = 0; k < points->size(); k += kLanes) {
    float* const x = points->mutable_x() + k;
    float* const y = points->mutable_y() + k;
    float* const z = points->mutable_z() + k;
    BodyLanes p;
    ProjectLanes<kModel>(c, x, y, z, &p);
    alignas(64) float moved[3][kLanes];
    for (int l = 0; l < kLanes; ++l) {
      // m/s: of a fixed point seen from the body, in its frame and in the camera's; then pixels/s.
      const float bx = c.w[2] * p.y[l] - c.w[1] * p.z[l] - c.v[0];
      const float by = c.w[0] * p.z[l] - c.w[2] * p.x[l] - c.v[1];
      const float bz = c.w[1] * p.x[l] - c.w[0] * p.y[l] - c.v[2];
      const float cx = C[0] * bx + C[1] * by + C[2] * bz;
      const float cy = C[3] * bx + C[4] * by + C[5] * bz;
      const float cz = C[6] * bx + C[7] * by + C[8] * bz;
      const float mx = (cx - p.mx[l] * cz) * p.inverse_z[l], my = (cy - p.my[l] * cz) * p.inverse_z[l];
      const float u = c.camera.fx * (p.dxx[l] * mx + p.dxy[l] * my);
      const float v = c.camera.fy * (p.dxy[l] * mx + p.dyy[l] * my);
      const float delay = p.ahead[l] * c.lag / (std::sqrt(u * u + v * v) + kSlow);  // s
      moved[0][l] = x[l] - delay * (B[0] * bx + B[3] * by + B[6] * bz);
      moved[1][l] = y[l] - delay * (B[1] * bx + B[4] * by + B[7] * bz);
      moved[2][l] = z[l] - delay * (B[2] * bx + B[5] * by + B[8] * bz);
    }
    // Only now: the batch's numbers could be these, as far as the compiler knows.
    std::copy_n(moved[0], kLanes, x);
    std::copy_n(moved[1], kLanes, y);
    std::copy_n(moved[2], kLanes, z);
  }
}

EVIT_MULTIVERSION void PlumbBobMoveBack(const LagBatch& c, PointArrays* points) {
  MoveBack<Camera::Model::kPlumbBob>(c, points);
}
EVIT_MULTIVERSION void EquidistantMoveBack(const LagBatch& c, PointArrays* points) {
  MoveBack<Camera::Model::kEquidistant>(c, points);
}

}  // namespace

AlignmentPoints CompensateEventLag(const AlignmentSettings& settings, AlignmentPoints points,
                                   const SE3& T_map_body, const Eigen::Vector3d& velocity,
                                   const Eigen::Vector3d& rate, double lag_px) {
  if (lag_px == 0) return points;
  const LagBatch batch(BatchView(settings, points, T_map_body), T_map_body, velocity, rate, lag_px);
  (batch.fisheye ? EquidistantMoveBack : PlumbBobMoveBack)(batch, points.mutable_local());
  return points;
}

}  // namespace evit
