#include "common/tracking/batch_samples.h"

#include <algorithm>
#include <initializer_list>

#include "common/tracking/alignment_lanes.h"

namespace evit {
namespace {

using Model = Camera::Model;

void Resize(std::size_t points, std::initializer_list<std::vector<float>*> arrays) {
  for (std::vector<float>* array : arrays) array->resize(points + kLanes);
}

template <Model kModel>
EVIT_ALWAYS_INLINE void Beside(const BatchAlignment& c, const PointArrays& points, float shift,
                               BesideSamples* out) {
  for (std::size_t k = 0; k < points.size(); k += kLanes) {
    BodyLanes p;
    FieldLanes f;
    ProjectLanes<kModel>(c, points.x() + k, points.y() + k, points.z() + k, &p);
    InsideLanes(c, p, 0, out->inside.data() + k);
    SampleLanes<false>(c.field, p.u, p.v, &f);
    std::copy_n(p.u, kLanes, out->u.data() + k);
    std::copy_n(p.v, kLanes, out->v.data() + k);
    std::copy_n(f.value, kLanes, out->value.data() + k);
    alignas(64) float sum[kLanes] = {};
    for (int side = 0; side < 4; ++side) {
      const float du = side == 0 ? shift : side == 1 ? -shift : 0;
      const float dv = side == 2 ? shift : side == 3 ? -shift : 0;
      alignas(64) float u[kLanes], v[kLanes];
      for (int l = 0; l < kLanes; ++l) u[l] = p.u[l] + du, v[l] = p.v[l] + dv;
      SampleLanes<false>(c.field, u, v, &f);
      for (int l = 0; l < kLanes; ++l) sum[l] += 0.25F * f.value[l];
    }
    std::copy_n(sum, kLanes, out->beside.data() + k);
  }
}

// Of rho(r^2) / 2 over the image plane.
struct PlaneLanes {
  alignas(64) float inside[kLanes];
  alignas(64) float gu[kLanes], gv[kLanes], cuu[kLanes], cuv[kLanes], cvv[kLanes];
};
EVIT_ALWAYS_INLINE void SampleOnPlane(const BatchAlignment& c, const BodyLanes& p, PlaneLanes* out) {
  FieldLanes f;
  alignas(64) float squared[kLanes], first[kLanes], second[kLanes];
  InsideLanes(c, p, 0, out->inside);
  SampleLanes<true>(c.field, p.u, p.v, &f);
  for (int l = 0; l < kLanes; ++l) {
    const float r = f.value[l] * c.inverse_sigma;
    squared[l] = r * r;
  }
  KernelSlopeLanes(c.kernel, squared, first, second);
  for (int l = 0; l < kLanes; ++l) {
    const float r = f.value[l] * c.inverse_sigma, rs = first[l] * r * c.inverse_sigma;
    const float gu = c.inverse_sigma * f.gx[l], gv = c.inverse_sigma * f.gy[l];
    const float along = first[l] + 2 * second[l] * squared[l];
    out->gu[l] = first[l] * r * gu;
    out->gv[l] = first[l] * r * gv;
    out->cuu[l] = along * gu * gu + rs * f.hxx[l];
    out->cuv[l] = along * gu * gv + rs * f.hxy[l];
    out->cvv[l] = along * gv * gv + rs * f.hyy[l];
  }
}

template <Model kModel>
EVIT_ALWAYS_INLINE void Plane(const BatchAlignment& c, const PointArrays& points, PlaneSamples* out) {
  for (std::size_t k = 0; k < points.size(); k += kLanes) {
    BodyLanes p;
    PlaneLanes m;
    ProjectLanes<kModel>(c, points.x() + k, points.y() + k, points.z() + k, &p);
    SampleOnPlane(c, p, &m);
    std::copy_n(m.inside, kLanes, out->inside.data() + k);
    std::copy_n(p.u, kLanes, out->u.data() + k);
    std::copy_n(p.v, kLanes, out->v.data() + k);
    std::copy_n(m.gu, kLanes, out->gu.data() + k);
    std::copy_n(m.gv, kLanes, out->gv.data() + k);
    std::copy_n(m.cuu, kLanes, out->cuu.data() + k);
    std::copy_n(m.cuv, kLanes, out->cuv.data() + k);
    std::copy_n(m.cvv, kLanes, out->cvv.data() + k);
    for (int l = 0; l < kLanes; ++l) out->depth[k + static_cast<std::size_t>(l)] = 1 / p.inverse_z[l];
  }
}

EVIT_MULTIVERSION_WIDE void PlumbBobBeside(const BatchAlignment& c, const PointArrays& p, float shift,
                                           BesideSamples* out) {
  Beside<Model::kPlumbBob>(c, p, shift, out);
}
EVIT_MULTIVERSION_WIDE void EquidistantBeside(const BatchAlignment& c, const PointArrays& p, float shift,
                                              BesideSamples* out) {
  Beside<Model::kEquidistant>(c, p, shift, out);
}
EVIT_MULTIVERSION_WIDE void PlumbBobPlane(const BatchAlignment& c, const PointArrays& p, PlaneSamples* out) {
  Plane<Model::kPlumbBob>(c, p, out);
}
EVIT_MULTIVERSION_WIDE void EquidistantPlane(const BatchAlignment& c, const PointArrays& p,
                                             PlaneSamples* out) {
  Plane<Model::kEquidistant>(c, p, out);
}

}  // namespace

BesideSamples SampleBeside(const BatchAlignment& batch, const PointArrays& points, float shift) {
  BesideSamples samples;
  Resize(points.size(), {&samples.inside, &samples.u, &samples.v, &samples.value, &samples.beside});
  (batch.fisheye ? EquidistantBeside : PlumbBobBeside)(batch, points, shift, &samples);
  return samples;
}

PlaneSamples SamplePlane(const BatchAlignment& batch, const PointArrays& points) {
  PlaneSamples samples;
  Resize(points.size(), {&samples.inside, &samples.u, &samples.v, &samples.depth, &samples.gu, &samples.gv,
                         &samples.cuu, &samples.cuv, &samples.cvv});
  (batch.fisheye ? EquidistantPlane : PlumbBobPlane)(batch, points, &samples);
  return samples;
}

}  // namespace evit
