#pragma once

#include <vector>

#include "common/mapping/posed_edges.h"

namespace evit {

struct LineThinningOptions {
  double voxel_m = 0.004;   // one point and direction each
  double reach_m = 0.015;   // along and around a line: points that have a say in where it runs
  bool finer_near = true;   // in scenes nearer than 1.3 m both shrink in proportion, see ForDepth
  double min_share = 0.25;  // of the voxels on the line through a point that hold points as well, see below
};

/// The options for a scene `depth_m` away: where voxels may, they shrink with it, so that lines of the map
/// stay as fine in the image.
LineThinningOptions ForDepth(LineThinningOptions options, double depth_m);

/// One point for each voxel and main direction: the mean of its points, weighted by their certainty. In the
/// order of the first point of each.
std::vector<MappedPoint> ThinToVoxels(const std::vector<MappedPoint>& points, double voxel_m);

/// Thins the bundle of points that many views leave along each edge to a line: points move onto the line
/// through their neighbours of the same direction, weighted by their certainty, and then one for each voxel
/// and main direction stays. In the order of the first point of each voxel.
std::vector<MappedPoint> ThinToLines(const std::vector<MappedPoint>& points,
                                     const LineThinningOptions& options, int threads);

/// Leaves out points that lie on no line of others: of the voxels within twice the reach along its direction
/// a share of `min_share` has to hold points of the same direction. What is left of an edge that was seen as
/// another one lies scattered in depth.
std::vector<MappedPoint> DropLonePoints(const std::vector<MappedPoint>& points,
                                        const LineThinningOptions& options, int threads);

}  // namespace evit
