#pragma once

#include <cstddef>

#include "common/map/point_map.h"

namespace evit {

struct DenoiseSettings {
  double radius = 0.02;    // m: within which neighbours count
  int min_neighbours = 5;  // including the point itself; with fewer it stays as it is, or is dropped
  // Median over the map: in a sparser map a lonely point is nothing unusual.
  double min_usual_neighbours = 10;
};

/// The defaults; for a map that knows its points' sigmas a radius of 0, as `evit map build` has thinned it.
DenoiseSettings DenoiseSettingsFor(const PointMap& map);

struct DenoiseSummary {
  std::size_t n_moved = 0;
  std::size_t n_dropped = 0;
};

/// Thins the bundle of points that many noisy views leave around each edge: a point moves onto the line
/// through its neighbours (their weighted mean and principal direction: one step of moving least squares), so
/// that a tracker's few hundred points know what all points of the map know. In a dense map points without
/// neighbours are taken for outliers and left out. Keeps the order of points. Same map, same result. Radius
/// 0: leaves all as it is.
DenoiseSummary Denoise(const DenoiseSettings& settings, PointMap* map);

}  // namespace evit
