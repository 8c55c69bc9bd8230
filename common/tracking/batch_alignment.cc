#include "common/tracking/batch_alignment.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

struct BodyLanes {  // points in the body frame and on the image
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
  alignas(64) float mx[kLanes], my[kLanes], inverse_z[kLanes];
  alignas(64) float dxx[kLanes], dxy[kLanes], dyy[kLanes];
  alignas(64) float u[kLanes], v[kLanes];
  alignas(64) float ahead[kLanes];  // 1, or 0 where the lens does not see the point
};

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void ProjectLanes(const BatchAlignment& c, const float* x, const float* y, const float* z,
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

// J: d(pixel coordinate)/d(position in the body frame, rotation), six arrays of lanes, from the coordinate's
// derivative (d0, d1) over the normalised plane.
EVIT_ALWAYS_INLINE void JacobianLanes(const BatchAlignment& c, const BodyLanes& p, const float* d0,
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

// Over the image plane, weighted: gradient (g0, g1), and M = slope * (g g^T + r [H]+), H's negative
// eigenvalues left out.
struct PlaneLanes {
  alignas(64) float g0[kLanes], g1[kLanes], m00[kLanes], m01[kLanes], m11[kLanes];
};
EVIT_ALWAYS_INLINE void CurvatureLanes(const BatchAlignment& c, const FieldLanes& f, const float* residual,
                                       const float* weight, PlaneLanes* out) {
  for (int l = 0; l < kLanes; ++l) {
    const float w = weight[l], r = residual[l], rs = r * c.inverse_sigma;
    const float gx = c.inverse_sigma * f.gx[l], gy = c.inverse_sigma * f.gy[l];
    const float mean = 0.5F * (f.hxx[l] + f.hyy[l]), half = 0.5F * (f.hxx[l] - f.hyy[l]);
    const float spread = std::sqrt(half * half + f.hxy[l] * f.hxy[l]);
    const float up = mean + spread, down = mean - spread;
    const float high = up > 0 ? up : 0, low = down > 0 ? down : 0;
    const float k = 0.5F * (high - low) / (spread > 1e-12F ? spread : 1e-12F), middle = 0.5F * (high + low);
    out->m00[l] = w * (gx * gx + rs * (middle + k * half));
    out->m11[l] = w * (gy * gy + rs * (middle - k * half));
    out->m01[l] = w * (gx * gy + rs * k * f.hxy[l]);
    out->g0[l] = w * r * gx;
    out->g1[l] = w * r * gy;
  }
}

EVIT_ALWAYS_INLINE void DerivativeLanes(const BatchAlignment& c, const BodyLanes& p, const FieldLanes& f,
                                        const float* residual, const float* weight, AlignmentSums* sums) {
  alignas(64) float U[6][kLanes], V[6][kLanes];
  PlaneLanes m;
  JacobianLanes(c, p, p.dxx, p.dxy, c.camera.fx, U);
  JacobianLanes(c, p, p.dxy, p.dyy, c.camera.fy, V);
  CurvatureLanes(c, f, residual, weight, &m);
  float(*hessian)[kLanes] = sums->hessian;
  for (int i = 0; i < 6; ++i) {
    alignas(64) float a0[kLanes], a1[kLanes];
    float* const __restrict gradient = sums->gradient[i];
    for (int l = 0; l < kLanes; ++l) {
      gradient[l] += U[i][l] * m.g0[l] + V[i][l] * m.g1[l];
      a0[l] = m.m00[l] * U[i][l] + m.m01[l] * V[i][l];
      a1[l] = m.m01[l] * U[i][l] + m.m11[l] * V[i][l];
    }
    for (int j = i; j < 6; ++j) {
      float* const __restrict cell = *hessian++;
      for (int l = 0; l < kLanes; ++l) cell[l] += a0[l] * U[j][l] + a1[l] * V[j][l];
    }
  }
}

template <Camera::Model kModel, bool kDerivatives>
EVIT_ALWAYS_INLINE void AddBlock(const BatchAlignment& c, const float* x, const float* y, const float* z,
                                 int n, AlignmentSums* sums) {
  BodyLanes p;
  FieldLanes f;
  ProjectLanes<kModel>(c, x, y, z, &p);
  SampleLanes<kDerivatives>(c.field, p.u, p.v, &f);
  alignas(64) float residual[kLanes], squared[kLanes], weight[kLanes] = {};
  for (int l = 0; l < kLanes; ++l) {
    residual[l] = (p.ahead[l] * f.value[l] + (1 - p.ahead[l]) * 255) * c.inverse_sigma;
    squared[l] = residual[l] * residual[l];
  }
  sums->rho += KernelLanes(c.kernel, squared, n, weight);
  if (!kDerivatives) return;
  for (int l = 0; l < kLanes; ++l) weight[l] *= l < n ? p.ahead[l] : 0;
  DerivativeLanes(c, p, f, residual, weight, sums);
}

template <Camera::Model kModel, bool kDerivatives>
EVIT_ALWAYS_INLINE void AddAll(const BatchAlignment& c, const PointArrays& points, AlignmentSums* sums) {
  const float *x = points.x(), *y = points.y(), *z = points.z();
  const auto n = static_cast<int>(points.size());
  for (int k = 0; k < n; k += kLanes) {
    AddBlock<kModel, kDerivatives>(c, x + k, y + k, z + k, n - k < kLanes ? n - k : kLanes, sums);
  }
}

template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void Beside(const BatchAlignment& c, const PointArrays& points, float width, float height,
                               float shift, float* value, float* beside, std::int32_t* inside) {
  const auto n = static_cast<int>(points.size());
  for (int k = 0; k < n; k += kLanes) {
    BodyLanes p;
    FieldLanes f;
    ProjectLanes<kModel>(c, points.x() + k, points.y() + k, points.z() + k, &p);
    SampleLanes<false>(c.field, p.u, p.v, &f);
    alignas(64) float sum[kLanes] = {};
    for (int l = 0; l < kLanes; ++l) {
      value[k + l] = f.value[l];
      inside[k + l] = static_cast<int>(p.u[l] >= 0) & static_cast<int>(p.v[l] >= 0) &
                      static_cast<int>(p.u[l] <= width - 1) & static_cast<int>(p.v[l] <= height - 1) &
                      static_cast<int>(p.ahead[l] > 0);
    }
    for (int side = 0; side < 4; ++side) {
      const float du = side == 0 ? shift : side == 1 ? -shift : 0;
      const float dv = side == 2 ? shift : side == 3 ? -shift : 0;
      alignas(64) float u[kLanes], v[kLanes];
      for (int l = 0; l < kLanes; ++l) u[l] = p.u[l] + du, v[l] = p.v[l] + dv;
      SampleLanes<false>(c.field, u, v, &f);
      for (int l = 0; l < kLanes; ++l) sum[l] += 0.25F * f.value[l];
    }
    for (int l = 0; l < kLanes; ++l) beside[k + l] = sum[l];
  }
}

constexpr auto kPlumbBob = Camera::Model::kPlumbBob;
constexpr auto kEquidistant = Camera::Model::kEquidistant;

EVIT_MULTIVERSION void PlumbBobTerm(const BatchAlignment& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kPlumbBob, true>(c, p, sums);
}
EVIT_MULTIVERSION void PlumbBobCost(const BatchAlignment& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kPlumbBob, false>(c, p, sums);
}
EVIT_MULTIVERSION void EquidistantTerm(const BatchAlignment& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kEquidistant, true>(c, p, sums);
}
EVIT_MULTIVERSION void EquidistantCost(const BatchAlignment& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kEquidistant, false>(c, p, sums);
}
EVIT_MULTIVERSION void PlumbBobBeside(const BatchAlignment& c, const PointArrays& p, float w, float h,
                                      float s, float* value, float* beside, std::int32_t* inside) {
  Beside<kPlumbBob>(c, p, w, h, s, value, beside, inside);
}
EVIT_MULTIVERSION void EquidistantBeside(const BatchAlignment& c, const PointArrays& p, float w, float h,
                                         float s, float* value, float* beside, std::int32_t* inside) {
  Beside<kEquidistant>(c, p, w, h, s, value, beside, inside);
}

void Copy(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, float* to_R, float* to_t) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) to_R[3 * r + c] = static_cast<float>(R(r, c));
    to_t[r] = static_cast<float>(t[r]);
  }
}

}  // namespace

BatchAlignment::BatchAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                               const AlignmentPoints& points, const SE3& T_map_body)
    : camera(settings.lane_camera()),
      fisheye(settings.camera().model == kEquidistant),
      field(field.Lanes(level)),
      inverse_sigma(static_cast<float>(1 / settings.image_sigma)),
      kernel(settings.kernel) {
  Copy(T_map_body.R().transpose(), T_map_body.p - points.origin(), R_bw, t_wb);
  Copy(settings.T_camera_body.R(), settings.T_camera_body.p, R_cb, t_cb);
}

void SumAlignment(const BatchAlignment& batch, const PointArrays& points, bool derivatives,
                  AlignmentSums* sums) {
  if (derivatives) {
    (batch.fisheye ? EquidistantTerm : PlumbBobTerm)(batch, points, sums);
  } else {
    (batch.fisheye ? EquidistantCost : PlumbBobCost)(batch, points, sums);
  }
}

void SampleBeside(const BatchAlignment& batch, const PointArrays& points, float width, float height,
                  float shift, float* value, float* beside, std::int32_t* inside) {
  (batch.fisheye ? EquidistantBeside : PlumbBobBeside)(batch, points, width, height, shift, value, beside,
                                                       inside);
}

}  // namespace evit
