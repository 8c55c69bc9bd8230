#pragma once

#include <vector>

#include "common/mapping/posed_edges.h"

namespace evit {

struct ViewChoiceOptions {
  double key_distance_m = 0.01;  // from one key view to the next, or
  double key_angle_deg = 2;
  int max_keys = 160;             // of more, evenly many: each asks all others
  double min_parallax_deg = 0.4;  // of a neighbour: less says nothing about depth,
  double max_parallax_deg = 20;   // more and an edge looks different, or is another one
  double min_overlap = 0.5;       // share of the picture that a neighbour also sees
  int neighbours = 14;
};

/// Views far enough from all key views before them, in their order; of too many every n-th.
std::vector<int> ChooseKeyViews(const std::vector<PosedEdges>& views, const ViewChoiceOptions& options);

/// The neighbours that view `key` is compared with, for a scene about `depth` m away: in sight of the same
/// things, and spread in where they look from, so that each edge has some that move across it, near ones that
/// can hardly be mistaken and far ones that are exact. Ascending; empty where the camera hardly moved.
std::vector<int> ChooseNeighbours(const std::vector<PosedEdges>& views, int key, double depth,
                                  const ViewChoiceOptions& options);

}  // namespace evit
