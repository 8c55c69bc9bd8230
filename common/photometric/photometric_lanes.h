#pragma once

#include <array>
#include <vector>

#include "common/photometric/event_image.h"
#include "common/tracking/batch_alignment.h"

namespace evit {

/// Points of one PhotometricScene in single precision, for loops over lanes.
struct PhotometricPoints {
  AlignmentPoints place;                     // map frame
  std::array<std::vector<float>, 6> change;  // PhotometricScene::Change of each, and a block of lanes more
};

/// What such a loop needs to know: from where the points are seen, and the event image.
struct PhotometricBatch : BatchView {
  PhotometricBatch(const AlignmentSettings& settings, const PhotometricPoints& points, const SE3& T_map_body,
                   const EventImage& events, int level);

  const float* image;
  int step;            // floats from row to row
  float scale, shift;  // its pixel from the sensor's: scale * u + shift
  float max_x, max_y;  // of places whose neighbours can all be read, in its pixels; the least is 1
};

/// The motion that a residual is made with: r = value * per_event - change . twist * per_size.
struct PhotometricMotion {
  std::array<float, 6> twist, pull;  // pull: the scene's mean of a a^T, times the twist
  float per_event, per_size;
};

/// Sums over points, each kept by lane so that the order of additions is the same on every machine. Over
/// (position in the body frame, rotation, twist).
struct PhotometricSums {
  double rho = 0;
  alignas(64) float gradient[12][kLanes] = {};
  alignas(64) float hessian[78][kLanes] = {};  // upper triangle, row by row
};
void SumPhotometric(const PhotometricBatch& batch, const PhotometricPoints& points,
                    const PhotometricMotion& motion, const LaneKernel& kernel, bool derivatives,
                    PhotometricSums* sums);

/// Sums of the event image at the points.
struct EventSums {
  double squared = 0;
  std::array<double, 6> by_change{};  // value * change
  int in_image = 0;                   // points
};
EventSums SumEvents(const PhotometricBatch& batch, const PhotometricPoints& points);

}  // namespace evit
