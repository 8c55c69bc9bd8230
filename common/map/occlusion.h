#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/geometry/camera.h"

namespace evit {

/// A map point in view.
struct ProjectedPoint {
  ProjectedPoint() {}  // NOLINT(modernize-use-equals-default): vectors of many are not cleared first
  ProjectedPoint(std::int32_t an_id, const Eigen::Vector2f& a_pixel, float a_depth)
      : id(an_id), pixel(a_pixel), depth(a_depth) {}

  std::int32_t id;  // index into the map
  Eigen::Vector2f pixel;
  float depth;  // m, along the optical axis
};

/// Removes points hidden behind nearer ones, by a coarse depth buffer of 8x8 pixel cells.
///
/// A semi-dense map holds edges, not surfaces: one nearer point beside the line of sight proves nothing, and
/// hiding by mistake costs good points. So a point counts as hidden only where points nearer by over 10 % and
/// 5 cm lie on several sides of it: in at least three of the four quadrants of its cell's neighbourhood (5x5
/// cells), with two or more each, which is what the edges of a nearer surface around it look like.
void RemoveOccluded(const Camera& camera, double margin_px, std::vector<ProjectedPoint>* points);

}  // namespace evit
