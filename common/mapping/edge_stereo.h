#pragma once

#include <vector>

#include "common/mapping/posed_edges.h"

namespace evit {

struct EdgeStereoOptions {
  double min_depth_m = 0.2, max_depth_m = 10;
  int min_views = 4;             // that agree on a depth
  double min_share = 0.35;       // of the views that should show it: more is hidden than one knows
  double max_rival_share = 0.6;  // another depth with as much of the best one's support makes it ambiguous
  double edge_sigma_px = 0.35;   // of an edge's place in one image, poses' errors included
  double normal_sigma = 0.03;    // rad, of an edge's direction in one image
  double max_relative_sigma = 0.06;  // of the depth; more is not a measurement
  double lag_sigma_px = 0.4;         // of an edge in event views, beside what is known of all
  double side_tolerance = 0.5;       // log intensity: by which one side at least must look the same
};

/// A depth measured for an edge of a view.
struct EdgeDepth {
  int edge = 0;                   // index into the view's edges
  double inverse_depth = 0;       // 1/m, along the optical axis
  double sigma = 0;               // of it, 1/m
  double slope = 0;               // of the inverse depth along the edge's tangent, 1/m per pixel
  double views = 0;               // that agree
  double lag = 0, lag_sigma = 0;  // px, by which event views see it behind its place; sigma 0: not known
};

/// Depth of the edges of one view from its neighbours, semi-dense multi-view stereo on edges.
///
/// For each edge pixel all inverse depths are tried at once in all neighbours: each neighbour votes for those
/// at which it has an edge of this direction on the epipolar line (EdgeImage::Vote). The highest peaks are
/// then made exact by least squares on the distances to the neighbours' edges, across these. An edge counts
/// only where one of its sides is about as bright as in the first view. What stays ambiguous, has too few
/// witnesses or runs along the epipolar lines is left out.
class EdgeStereo {
 public:
  EdgeStereo(const std::vector<PosedEdges>& views, const EdgeStereoOptions& options)
      : views_(views), options_(options) {}

  /// `stride`: every how many-th edge of the view is measured. `typical_depth`: m, of the scene; which edges
  /// an event camera's views show is told by it. Ascending by edge.
  std::vector<EdgeDepth> Measure(int key, const std::vector<int>& neighbours, int stride,
                                 double typical_depth) const;

 private:
  struct Neighbour;
  struct Fit;
  std::vector<Neighbour> Prepare(int key, const std::vector<int>& neighbours) const;
  Fit Refine(const EdgePixel& edge, const std::vector<Neighbour>& neighbours, double inverse_depth,
             double step) const;

  const std::vector<PosedEdges>& views_;
  EdgeStereoOptions options_;
};

}  // namespace evit
