#include "common/tracking/batch_alignment.h"

#include <cmath>
#include <numeric>

#include "common/tracking/alignment_lanes.h"

namespace evit {
namespace {

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

// The same with all of H, and of the kernel: M = (rho' + 2 rho'' r^2) g g^T + rho' r H.
EVIT_ALWAYS_INLINE void ExactCurvatureLanes(const BatchAlignment& c, const FieldLanes& f,
                                            const float* residual, const float* slope, const float* bend,
                                            PlaneLanes* out) {
  for (int l = 0; l < kLanes; ++l) {
    const float r = residual[l], rs = slope[l] * r * c.inverse_sigma;
    const float along = slope[l] + 2 * bend[l] * r * r;
    const float gx = c.inverse_sigma * f.gx[l], gy = c.inverse_sigma * f.gy[l];
    out->m00[l] = along * gx * gx + rs * f.hxx[l];
    out->m11[l] = along * gy * gy + rs * f.hyy[l];
    out->m01[l] = along * gx * gy + rs * f.hxy[l];
    out->g0[l] = slope[l] * r * gx;
    out->g1[l] = slope[l] * r * gy;
  }
}

EVIT_ALWAYS_INLINE void DerivativeLanes(const BatchAlignment& c, const BodyLanes& p, const PlaneLanes& m,
                                        AlignmentSums* sums) {
  alignas(64) float U[6][kLanes], V[6][kLanes];
  JacobianLanes(c, p, p.dxx, p.dxy, c.camera.fx, U);
  JacobianLanes(c, p, p.dxy, p.dyy, c.camera.fy, V);
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

template <Camera::Model kModel, AlignmentPart kPart>
EVIT_ALWAYS_INLINE void AddBlock(const BatchAlignment& c, const float* x, const float* y, const float* z,
                                 int n, AlignmentSums* sums) {
  BodyLanes p;
  FieldLanes f;
  ProjectLanes<kModel>(c, x, y, z, &p);
  SampleLanes<kPart != AlignmentPart::kCost>(c.field, p.u, p.v, &f);
  alignas(64) float residual[kLanes], squared[kLanes], weight[kLanes] = {};
  for (int l = 0; l < kLanes; ++l) {
    residual[l] = (p.ahead[l] * f.value[l] + (1 - p.ahead[l]) * 255) * c.inverse_sigma;
    squared[l] = residual[l] * residual[l];
  }
  sums->rho += KernelLanes(c.kernel, squared, n, weight);
  if (kPart == AlignmentPart::kCost) return;
  PlaneLanes m;
  if (kPart == AlignmentPart::kExact) {
    alignas(64) float bend[kLanes] = {};
    KernelSlopeLanes(c.kernel, squared, weight, bend);
    for (int l = 0; l < kLanes; ++l) {
      const float counts = l < n ? p.ahead[l] : 0;
      weight[l] *= counts;
      bend[l] *= counts;
    }
    ExactCurvatureLanes(c, f, residual, weight, bend, &m);
  } else {
    for (int l = 0; l < kLanes; ++l) weight[l] *= l < n ? p.ahead[l] : 0;
    CurvatureLanes(c, f, residual, weight, &m);
  }
  DerivativeLanes(c, p, m, sums);
}

template <Camera::Model kModel, AlignmentPart kPart>
EVIT_ALWAYS_INLINE void AddAll(const BatchAlignment& c, const PointArrays& points, AlignmentSums* sums) {
  const float *x = points.x(), *y = points.y(), *z = points.z();
  const auto n = static_cast<int>(points.size());
  for (int k = 0; k < n; k += kLanes) {
    AddBlock<kModel, kPart>(c, x + k, y + k, z + k, n - k < kLanes ? n - k : kLanes, sums);
  }
}

constexpr auto kPlumbBob = Camera::Model::kPlumbBob;
constexpr auto kEquidistant = Camera::Model::kEquidistant;

EVIT_MULTIVERSION_WIDE void PlumbBobCost(const BatchAlignment& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kPlumbBob, AlignmentPart::kCost>(c, p, sums);
}
EVIT_MULTIVERSION_WIDE void PlumbBobSafe(const BatchAlignment& c, const PointArrays& p, AlignmentSums* sums) {
  AddAll<kPlumbBob, AlignmentPart::kSafe>(c, p, sums);
}
EVIT_MULTIVERSION_WIDE void PlumbBobExact(const BatchAlignment& c, const PointArrays& p,
                                          AlignmentSums* sums) {
  AddAll<kPlumbBob, AlignmentPart::kExact>(c, p, sums);
}
EVIT_MULTIVERSION_WIDE void EquidistantCost(const BatchAlignment& c, const PointArrays& p,
                                            AlignmentSums* sums) {
  AddAll<kEquidistant, AlignmentPart::kCost>(c, p, sums);
}
EVIT_MULTIVERSION_WIDE void EquidistantSafe(const BatchAlignment& c, const PointArrays& p,
                                            AlignmentSums* sums) {
  AddAll<kEquidistant, AlignmentPart::kSafe>(c, p, sums);
}
EVIT_MULTIVERSION_WIDE void EquidistantExact(const BatchAlignment& c, const PointArrays& p,
                                             AlignmentSums* sums) {
  AddAll<kEquidistant, AlignmentPart::kExact>(c, p, sums);
}
void Copy(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, float* to_R, float* to_t) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) to_R[3 * r + c] = static_cast<float>(R(r, c));
    to_t[r] = static_cast<float>(t[r]);
  }
}

}  // namespace

BatchView::BatchView(const AlignmentSettings& settings, const AlignmentPoints& points, const SE3& T_map_body)
    : camera(settings.lane_camera()),
      fisheye(settings.camera().model == kEquidistant),
      width(static_cast<float>(settings.camera().width)),
      height(static_cast<float>(settings.camera().height)) {
  Copy(T_map_body.R().transpose(), T_map_body.p - points.origin(), R_bw, t_wb);
  Copy(settings.T_camera_body.R(), settings.T_camera_body.p, R_cb, t_cb);
}

BatchAlignment::BatchAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                               const AlignmentPoints& points, const SE3& T_map_body)
    : BatchView(settings, points, T_map_body),
      field(field.Lanes(level)),
      inverse_sigma(static_cast<float>(1 / settings.image_sigma)),
      kernel(settings.kernel) {}

void SumAlignment(const BatchAlignment& batch, const PointArrays& points, AlignmentPart part,
                  AlignmentSums* sums) {
  switch (part) {
    case AlignmentPart::kCost:
      return (batch.fisheye ? EquidistantCost : PlumbBobCost)(batch, points, sums);
    case AlignmentPart::kSafe:
      return (batch.fisheye ? EquidistantSafe : PlumbBobSafe)(batch, points, sums);
    case AlignmentPart::kExact:
      return (batch.fisheye ? EquidistantExact : PlumbBobExact)(batch, points, sums);
  }
}

double SumLanes(const float* lanes) { return std::accumulate(lanes, lanes + kLanes, 0.0); }

Matrix6d HessianOfLanes(const float (*upper)[kLanes], const SE3& T_map_body) {
  Matrix6d hessian;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) hessian(i, j) = hessian(j, i) = SumLanes(*upper++);
  }
  Matrix6d turn = Matrix6d::Identity();
  turn.topLeftCorner<3, 3>() = T_map_body.R();
  return turn * hessian * turn.transpose();
}

}  // namespace evit
