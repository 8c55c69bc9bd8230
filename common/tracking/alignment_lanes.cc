#include "common/tracking/alignment_lanes.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

struct BodyLanes {  // points in the body frame and on the image
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
  alignas(64) float mx[kLanes], my[kLanes], inverse_z[kLanes];
  alignas(64) float dxx[kLanes], dxy[kLanes], dyy[kLanes];
  alignas(64) float u[kLanes], v[kLanes];
  alignas(64) std::int32_t ahead[kLanes];
};

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void ProjectLanes(const AlignmentLanes& c, const float* x, const float* y, const float* z,
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
    const bool front = pz > 1e-6F;
    const float inverse = 1 / (front ? pz : 1);
    const float mx = px * inverse, my = py * inverse;
    const bool ahead = static_cast<int>(front) & static_cast<int>(mx * mx + my * my <= c.camera.max_radius2);
    const float sx = ahead ? mx : 0, sy = ahead ? my : 0;  // finite, so that they can become an index
    const LaneDistortion d = DistortLane<kModel>(c.camera, sx, sy);
    out->x[l] = bx, out->y[l] = by, out->z[l] = bz;
    out->mx[l] = sx, out->my[l] = sy, out->inverse_z[l] = inverse;
    out->dxx[l] = d.dxx, out->dxy[l] = d.dxy, out->dyy[l] = d.dyy;
    out->u[l] = c.camera.fx * d.x + c.camera.cx;
    out->v[l] = c.camera.fy * d.y + c.camera.cy;
    out->ahead[l] = ahead ? 1 : 0;
  }
}

// rho and rho' of squared residuals s; lanes from n on count nothing.
EVIT_ALWAYS_INLINE double KernelLanes(const AlignmentLanes& c, const float* s, int n, float* slope) {
  alignas(64) float rho[kLanes];
  double sum = 0;
  const float c2 = c.c * c.c;
  switch (c.kernel) {
    case RobustKernel::Kind::kCauchy: {
      // One logarithm for the product of all: the logarithm was a sixth of a solve.
      for (int l = 0; l < kLanes; ++l) {
        rho[l] = 1 + s[l] * c.inverse_c2;
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
        const bool inlier = r <= c.c;
        rho[l] = inlier ? s[l] : 2 * c.c * r - c2;
        slope[l] = inlier ? 1 : c.c / r;
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

EVIT_ALWAYS_INLINE void DerivativeLanes(const AlignmentLanes& c, const BodyLanes& p, const FieldLanes& f,
                                        const float* residual, const float* weight, AlignmentSums* sums) {
  const float* const C = c.R_cb;
  for (int l = 0; l < kLanes; ++l) {
    // d(pixel)/d(point of the camera), then over (position in the body frame, rotation).
    const float iz = p.inverse_z[l];
    float J[2][6];
    for (int row = 0; row < 2; ++row) {
      const float f_pixels = row == 0 ? c.camera.fx : c.camera.fy;
      const float d0 = f_pixels * iz * (row == 0 ? p.dxx[l] : p.dxy[l]);
      const float d1 = f_pixels * iz * (row == 0 ? p.dxy[l] : p.dyy[l]);
      const float d2 = -(d0 * p.mx[l] + d1 * p.my[l]);
      const float jx = -(d0 * C[0] + d1 * C[3] + d2 * C[6]);
      const float jy = -(d0 * C[1] + d1 * C[4] + d2 * C[7]);
      const float jz = -(d0 * C[2] + d1 * C[5] + d2 * C[8]);
      J[row][0] = jx, J[row][1] = jy, J[row][2] = jz;
      J[row][3] = p.y[l] * jz - p.z[l] * jy;  // p_body x j
      J[row][4] = p.z[l] * jx - p.x[l] * jz;
      J[row][5] = p.x[l] * jy - p.y[l] * jx;
    }
    // M = slope * (g g^T + r [H]+), H's negative eigenvalues left out.
    const float w = weight[l], r = residual[l];
    const float gx = c.inverse_sigma * f.gx[l], gy = c.inverse_sigma * f.gy[l];
    const float mean = 0.5F * (f.hxx[l] + f.hyy[l]), half = 0.5F * (f.hxx[l] - f.hyy[l]);
    const float spread = std::sqrt(half * half + f.hxy[l] * f.hxy[l]);
    const float high = mean + spread > 0 ? mean + spread : 0, low = mean - spread > 0 ? mean - spread : 0;
    const float k = 0.5F * (high - low) / (spread > 1e-12F ? spread : 1), middle = 0.5F * (high + low);
    const float rs = r * c.inverse_sigma;
    const float m00 = w * (gx * gx + rs * (middle + k * half));
    const float m11 = w * (gy * gy + rs * (middle - k * half));
    const float m01 = w * (gx * gy + rs * k * f.hxy[l]);
    const float g0 = w * r * gx, g1 = w * r * gy;
    int at = 0;
    for (int i = 0; i < 6; ++i) {
      sums->gradient[i][l] += J[0][i] * g0 + J[1][i] * g1;
      const float a0 = m00 * J[0][i] + m01 * J[1][i], a1 = m01 * J[0][i] + m11 * J[1][i];
      for (int j = i; j < 6; ++j) sums->hessian[at++][l] += a0 * J[0][j] + a1 * J[1][j];
    }
  }
}

template <Camera::Model kModel, bool kDerivatives>
EVIT_ALWAYS_INLINE void AddBlock(const AlignmentLanes& c, const float* x, const float* y, const float* z, int n,
                                 AlignmentSums* sums) {
  BodyLanes p;
  FieldLanes f;
  ProjectLanes<kModel>(c, x, y, z, &p);
  SampleLanes<kDerivatives>(c.field, p.u, p.v, &f);
  alignas(64) float residual[kLanes], squared[kLanes], weight[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    residual[l] = (p.ahead[l] != 0 ? f.value[l] : 255) * c.inverse_sigma;
    squared[l] = residual[l] * residual[l];
  }
  sums->rho += KernelLanes(c, squared, n, weight);
  if (!kDerivatives) return;
  for (int l = 0; l < kLanes; ++l) weight[l] = (static_cast<int>(l < n) & p.ahead[l]) != 0 ? weight[l] : 0;
  DerivativeLanes(c, p, f, residual, weight, sums);
}

// Calls block(x, y, z, n of valid lanes, first point) for all points.
template <typename Block>
EVIT_ALWAYS_INLINE void ForEachBlock(const PointArrays& points, const Block& block) {
  const std::size_t n = points.size();
  std::size_t k = 0;
  for (; k + kLanes <= n; k += kLanes) block(&points.x[k], &points.y[k], &points.z[k], kLanes, k);
  if (k == n) return;
  alignas(64) float rest[3][kLanes] = {};
  for (std::size_t l = 0; k + l < n; ++l) {
    rest[0][l] = points.x[k + l], rest[1][l] = points.y[k + l], rest[2][l] = points.z[k + l];
  }
  block(rest[0], rest[1], rest[2], static_cast<int>(n - k), k);
}

template <Camera::Model kModel, bool kDerivatives>
EVIT_ALWAYS_INLINE void AddAll(const AlignmentLanes& c, const PointArrays& points, AlignmentSums* sums) {
  ForEachBlock(points, [&](const float* x, const float* y, const float* z, int n, std::size_t)
                           __attribute__((always_inline)) { AddBlock<kModel, kDerivatives>(c, x, y, z, n, sums); });
}

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void Beside(const AlignmentLanes& c, const PointArrays& points, float width, float height,
                               float shift, float* value, float* beside, std::int32_t* inside) {
  ForEachBlock(points, [&](const float* x, const float* y, const float* z, int n, std::size_t first)
                           __attribute__((always_inline)) {
                             BodyLanes p;
                             FieldLanes f;
                             ProjectLanes<kModel>(c, x, y, z, &p);
                             SampleLanes<false>(c.field, p.u, p.v, &f);
                             for (int l = 0; l < kLanes; ++l) {
                               value[first + l] = f.value[l];
                               beside[first + l] = 0;
                               const bool in = static_cast<int>(p.u[l] >= 0) & static_cast<int>(p.v[l] >= 0) &
                                               static_cast<int>(p.u[l] <= width - 1) &
                                               static_cast<int>(p.v[l] <= height - 1) &
                                               static_cast<int>(l < n) & p.ahead[l];
                               inside[first + l] = in ? 1 : 0;
                             }
                             for (int side = 0; side < 4; ++side) {
                               const float du = side == 0 ? shift : side == 1 ? -shift : 0;
                               const float dv = side == 2 ? shift : side == 3 ? -shift : 0;
                               alignas(64) float u[kLanes], v[kLanes];
                               for (int l = 0; l < kLanes; ++l) u[l] = p.u[l] + du, v[l] = p.v[l] + dv;
                               SampleLanes<false>(c.field, u, v, &f);
                               for (int l = 0; l < kLanes; ++l) beside[first + l] += 0.25F * f.value[l];
                             }
                           });
}

constexpr auto kPlumbBob = Camera::Model::kPlumbBob;
constexpr auto kEquidistant = Camera::Model::kEquidistant;

EVIT_MULTIVERSION void PlumbBobTerm(const AlignmentLanes& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kPlumbBob, true>(c, p, sums);
}
EVIT_MULTIVERSION void PlumbBobCost(const AlignmentLanes& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kPlumbBob, false>(c, p, sums);
}
EVIT_MULTIVERSION void EquidistantTerm(const AlignmentLanes& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kEquidistant, true>(c, p, sums);
}
EVIT_MULTIVERSION void EquidistantCost(const AlignmentLanes& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kEquidistant, false>(c, p, sums);
}
EVIT_MULTIVERSION void PlumbBobBeside(const AlignmentLanes& c, const PointArrays& p, float w, float h, float s,
                                      float* value, float* beside, std::int32_t* inside) {
  Beside<kPlumbBob>(c, p, w, h, s, value, beside, inside);
}
EVIT_MULTIVERSION void EquidistantBeside(const AlignmentLanes& c, const PointArrays& p, float w, float h, float s,
                                         float* value, float* beside, std::int32_t* inside) {
  Beside<kEquidistant>(c, p, w, h, s, value, beside, inside);
}

void Copy(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, float* to_R, float* to_t) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) to_R[3 * r + c] = static_cast<float>(R(r, c));
    to_t[r] = static_cast<float>(t[r]);
  }
}

}  // namespace

AlignmentLanes::AlignmentLanes(const AlignmentSettings& settings, const SurfaceField& field, int level,
                               const AlignmentPoints& points, const SE3& T_world_body)
    : camera(settings.lane_camera()),
      fisheye(settings.camera().model == kEquidistant),
      field(field.Lanes(level)),
      inverse_sigma(static_cast<float>(1 / settings.image_sigma)),
      kernel(settings.kernel.kind),
      inverse_c2(static_cast<float>(1 / (settings.kernel.scale * settings.kernel.scale))),
      c(static_cast<float>(settings.kernel.scale)) {
  Copy(T_world_body.R().transpose(), T_world_body.p - points.origin(), R_bw, t_wb);
  Copy(settings.T_camera_body.R(), settings.T_camera_body.p, R_cb, t_cb);
}

void SumAlignment(const AlignmentLanes& lanes, const PointArrays& points, bool derivatives,
                  AlignmentSums* sums) {
  if (derivatives) {
    (lanes.fisheye ? EquidistantTerm : PlumbBobTerm)(lanes, points, sums);
  } else {
    (lanes.fisheye ? EquidistantCost : PlumbBobCost)(lanes, points, sums);
  }
}

void SampleBeside(const AlignmentLanes& lanes, const PointArrays& points, float width, float height, float shift,
                  float* value, float* beside, std::int32_t* inside) {
  (lanes.fisheye ? EquidistantBeside : PlumbBobBeside)(lanes, points, width, height, shift, value, beside,
                                                       inside);
}

}  // namespace evit
