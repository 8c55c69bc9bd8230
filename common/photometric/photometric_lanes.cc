#include "common/photometric/photometric_lanes.h"

#include <algorithm>

#include "common/tracking/alignment_lanes.h"

namespace evit {
namespace {

constexpr auto kPlumbBob = Camera::Model::kPlumbBob;
constexpr auto kEquidistant = Camera::Model::kEquidistant;

// The event image at points, and its slope per sensor pixel; all 0 where it cannot be read, as
// EventImage::At.
struct ImageLanes {
  alignas(64) float value[kLanes], gx[kLanes], gy[kLanes];
};
EVIT_ALWAYS_INLINE void ReadLanes(const PhotometricBatch& c, const BodyLanes& p, ImageLanes* out) {
  alignas(64) float a[kLanes], b[kLanes], inside[kLanes];
  alignas(64) float tap[9][kLanes];
  alignas(64) std::int32_t corner[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const float u = c.scale * p.u[l] + c.shift, v = c.scale * p.v[l] + c.shift;
    inside[l] = p.ahead[l] * (u > 1 ? 1.0F : 0.0F) * (v > 1 ? 1.0F : 0.0F) * (u < c.max_x ? 1.0F : 0.0F) *
                (v < c.max_y ? 1.0F : 0.0F);
    const float x = inside[l] != 0 ? u : 1, y = inside[l] != 0 ? v : 1;
    const auto i =
        static_cast<int>(x + 0.5F);  // NOLINT(bugprone-incorrect-roundings): positive, and lround is slow
    const auto j = static_cast<int>(y + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
    a[l] = x - static_cast<float>(i);
    b[l] = y - static_cast<float>(j);
    corner[l] = (j - 1) * c.step + (i - 1);
  }
  for (int l = 0; l < kLanes; ++l) {
    const float* const row = c.image + corner[l];
    for (int k = 0; k < 9; ++k) tap[k][l] = row[k / 3 * c.step + k % 3];
  }
  for (int l = 0; l < kLanes; ++l) {
    const float x = a[l], y = b[l], seen = inside[l];
    const float x0 = 0.5F * (0.5F - x) * (0.5F - x), x1 = 0.75F - x * x, x2 = 0.5F * (0.5F + x) * (0.5F + x);
    const float y0 = 0.5F * (0.5F - y) * (0.5F - y), y1 = 0.75F - y * y, y2 = 0.5F * (0.5F + y) * (0.5F + y);
    float line[3], slope[3];
    for (std::size_t r = 0; r < 3; ++r) {
      const float t0 = tap[3 * r][l], t1 = tap[3 * r + 1][l], t2 = tap[3 * r + 2][l];
      line[r] = x0 * t0 + x1 * t1 + x2 * t2;
      slope[r] = (x - 0.5F) * t0 - 2 * x * t1 + (x + 0.5F) * t2;
    }
    out->value[l] = seen * (y0 * line[0] + y1 * line[1] + y2 * line[2]);
    out->gx[l] = seen * c.scale * (y0 * slope[0] + y1 * slope[1] + y2 * slope[2]);
    out->gy[l] = seen * c.scale * ((y - 0.5F) * line[0] - 2 * y * line[1] + (y + 0.5F) * line[2]);
  }
}

// J: d(residual)/d(position in the body frame, rotation, twist).
EVIT_ALWAYS_INLINE void AddDerivatives(const float (*J)[kLanes], const float* residual, const float* weight,
                                       PhotometricSums* sums) {
  float(*hessian)[kLanes] = sums->hessian;
  for (int i = 0; i < 12; ++i) {
    alignas(64) float wJ[kLanes];
    float* const __restrict gradient = sums->gradient[i];
    for (int l = 0; l < kLanes; ++l) {
      wJ[l] = weight[l] * J[i][l];
      gradient[l] += wJ[l] * residual[l];
    }
    for (int j = i; j < 12; ++j) {
      float* const __restrict cell = *hessian++;
      for (int l = 0; l < kLanes; ++l) cell[l] += wJ[l] * J[j][l];
    }
  }
}

template <Camera::Model kModel, bool kDerivatives>
EVIT_ALWAYS_INLINE void AddBlock(const PhotometricBatch& c, const PhotometricPoints& points, std::size_t k,
                                 int n, const PhotometricMotion& m, const LaneKernel& kernel,
                                 PhotometricSums* sums) {
  BodyLanes p;
  ImageLanes e;
  const PointArrays& place = points.place.local();
  ProjectLanes<kModel>(c, place.x() + k, place.y() + k, place.z() + k, &p);
  ReadLanes(c, p, &e);
  const float* a[6];
  for (std::size_t i = 0; i < 6; ++i) a[i] = points.change[i].data() + k;
  alignas(64) float predicted[kLanes], residual[kLanes], squared[kLanes], weight[kLanes] = {};
  for (int l = 0; l < kLanes; ++l) {
    float sum = 0;
    for (std::size_t i = 0; i < 6; ++i) sum += a[i][l] * m.twist[i];
    predicted[l] = sum * m.per_size;
    residual[l] = e.value[l] * m.per_event - predicted[l];
    squared[l] = residual[l] * residual[l];
  }
  sums->rho += KernelLanes(kernel, squared, n, weight);
  if (!kDerivatives) return;
  alignas(64) float J[12][kLanes], d0[kLanes], d1[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    weight[l] = l < n ? weight[l] : 0;
    const float gx = m.per_event * e.gx[l] * c.camera.fx, gy = m.per_event * e.gy[l] * c.camera.fy;
    d0[l] = gx * p.dxx[l] + gy * p.dxy[l];
    d1[l] = gx * p.dxy[l] + gy * p.dyy[l];
  }
  JacobianLanes(c, p, d0, d1, 1, J);
  const float per_size2 = m.per_size * m.per_size;
  for (std::size_t i = 0; i < 6; ++i) {
    for (int l = 0; l < kLanes; ++l)
      J[6 + i][l] = predicted[l] * per_size2 * m.pull[i] - m.per_size * a[i][l];
  }
  AddDerivatives(J, residual, weight, sums);
}

template <Camera::Model kModel, bool kDerivatives>
EVIT_ALWAYS_INLINE void AddAll(const PhotometricBatch& c, const PhotometricPoints& points,
                               const PhotometricMotion& m, const LaneKernel& kernel, PhotometricSums* sums) {
  const std::size_t n = points.place.size();
  for (std::size_t k = 0; k < n; k += kLanes) {
    AddBlock<kModel, kDerivatives>(c, points, k, n - k < kLanes ? static_cast<int>(n - k) : kLanes, m, kernel,
                                   sums);
  }
}

EVIT_MULTIVERSION_WIDE void PlumbBobCost(const PhotometricBatch& c, const PhotometricPoints& p,
                                         const PhotometricMotion& m, const LaneKernel& kernel,
                                         PhotometricSums* sums) {
  AddAll<kPlumbBob, false>(c, p, m, kernel, sums);
}
EVIT_MULTIVERSION_WIDE void PlumbBobAll(const PhotometricBatch& c, const PhotometricPoints& p,
                                        const PhotometricMotion& m, const LaneKernel& kernel,
                                        PhotometricSums* sums) {
  AddAll<kPlumbBob, true>(c, p, m, kernel, sums);
}
EVIT_MULTIVERSION_WIDE void EquidistantCost(const PhotometricBatch& c, const PhotometricPoints& p,
                                            const PhotometricMotion& m, const LaneKernel& kernel,
                                            PhotometricSums* sums) {
  AddAll<kEquidistant, false>(c, p, m, kernel, sums);
}
EVIT_MULTIVERSION_WIDE void EquidistantAll(const PhotometricBatch& c, const PhotometricPoints& p,
                                           const PhotometricMotion& m, const LaneKernel& kernel,
                                           PhotometricSums* sums) {
  AddAll<kEquidistant, true>(c, p, m, kernel, sums);
}

// value * value and value * change of each lane, and 1 where it is in the image.
struct EventLanes {
  alignas(64) float squared[kLanes] = {}, by_change[6][kLanes] = {}, in_image[kLanes] = {};
};
template <Camera::Model kModel>
EVIT_ALWAYS_INLINE void AddEvents(const PhotometricBatch& c, const PhotometricPoints& points,
                                  EventLanes* sums) {
  const PointArrays& place = points.place.local();
  const auto n = static_cast<int>(place.size());
  for (int k = 0; k < n; k += kLanes) {
    BodyLanes p;
    ImageLanes e;
    alignas(64) float inside[kLanes];
    ProjectLanes<kModel>(c, place.x() + k, place.y() + k, place.z() + k, &p);
    ReadLanes(c, p, &e);
    InsideLanes(c, p, 0, inside);
    for (int l = 0; l < kLanes; ++l) {
      const float counts = k + l < n ? 1 : 0;
      e.value[l] *= counts;
      sums->squared[l] += e.value[l] * e.value[l];
      sums->in_image[l] += counts * inside[l];
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const float* const a = points.change[i].data() + k;
      for (int l = 0; l < kLanes; ++l) sums->by_change[i][l] += e.value[l] * a[l];
    }
  }
}
EVIT_MULTIVERSION void PlumbBobEvents(const PhotometricBatch& c, const PhotometricPoints& p,
                                      EventLanes* sums) {
  AddEvents<kPlumbBob>(c, p, sums);
}
EVIT_MULTIVERSION void EquidistantEvents(const PhotometricBatch& c, const PhotometricPoints& p,
                                         EventLanes* sums) {
  AddEvents<kEquidistant>(c, p, sums);
}

}  // namespace

PhotometricBatch::PhotometricBatch(const AlignmentSettings& settings, const PhotometricPoints& points,
                                   const SE3& T_map_body, const EventImage& events, int level)
    : BatchView(settings, points.place, T_map_body),
      image(events.image(level).ptr<float>()),
      step(static_cast<int>(events.image(level).step1())),
      scale(1.0F / static_cast<float>(2 << level)),
      shift(0.5F * scale - 0.5F),
      max_x(static_cast<float>(events.image(level).cols - 2)),
      max_y(static_cast<float>(events.image(level).rows - 2)) {}

void SumPhotometric(const PhotometricBatch& batch, const PhotometricPoints& points,
                    const PhotometricMotion& motion, const LaneKernel& kernel, bool derivatives,
                    PhotometricSums* sums) {
  const auto run = derivatives ? (batch.fisheye ? EquidistantAll : PlumbBobAll)
                               : (batch.fisheye ? EquidistantCost : PlumbBobCost);
  run(batch, points, motion, kernel, sums);
}

EventSums SumEvents(const PhotometricBatch& batch, const PhotometricPoints& points) {
  EventLanes lanes;
  (batch.fisheye ? EquidistantEvents : PlumbBobEvents)(batch, points, &lanes);
  EventSums sums;
  sums.squared = SumLanes(lanes.squared);
  for (std::size_t i = 0; i < 6; ++i) sums.by_change[i] = SumLanes(lanes.by_change[i]);
  sums.in_image = static_cast<int>(SumLanes(lanes.in_image));
  return sums;
}

}  // namespace evit
