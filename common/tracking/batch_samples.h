#pragma once

#include <vector>

#include "common/tracking/batch_alignment.h"

/// What a surface says at each point of a BatchAlignment, for statistics over points: as fast as the sums
/// that the solver asks for. Arrays have one element for each point, and some more up to a whole block of
/// lanes.
namespace evit {

/// Where points show, and how well they lie there.
struct BesideSamples {
  std::vector<float> inside;         // 1 in the image, else 0: nothing else of that point counts
  std::vector<float> u, v;           // pixels
  std::vector<float> value, beside;  // grey levels: there, and the mean of the four places `shift` beside it
};
/// `shift`: pixels.
BesideSamples SampleBeside(const BatchAlignment& batch, const PointArrays& points, float shift);

/// What a point adds to the alignment term's cost rho(r^2) / 2, as a function of where it lies on the image:
/// exact gradient and curvature (AlignmentTerm keeps the curvature's positive part alone), per pixel and
/// squared pixel.
struct PlaneSamples {
  std::vector<float> inside;         // 1 in the image, else 0: nothing else of that point counts
  std::vector<float> u, v;           // pixels
  std::vector<float> depth;          // m, along the optical axis
  std::vector<float> gu, gv;         // gradient
  std::vector<float> cuu, cuv, cvv;  // curvature
};
PlaneSamples SamplePlane(const BatchAlignment& batch, const PointArrays& points);

}  // namespace evit
