#pragma once

#include <array>
#include <vector>

#include "common/mapping/stereo_neighbour.h"

namespace evit {

/// The inverse depths (1/m) that are tried: `steps` of them from `low`, in steps of about a pixel in the
/// neighbour that moves most.
struct DepthSteps {
  DepthSteps(double low, double high, const std::vector<StereoNeighbour>& neighbours);

  double low, step = 0;
  int steps = 0;  // 0: no neighbour has moved, and none tells of depth
};

/// An inverse depth that views agree on, and their share; 0: none.
struct DepthPeak {
  float share = 0;
  double inverse_depth = 0;
};

/// The neighbours' votes for an edge's inverse depth.
class DepthVotes {
 public:
  static constexpr int kPeaks = 4;

  explicit DepthVotes(const DepthSteps& steps)
      : steps_(steps), votes_(steps.steps), seen_(steps.steps), share_(steps.steps) {}

  void Clear();
  /// For all inverse depths at which it has an edge of this direction on the epipolar line.
  void Add(const StereoNeighbour& neighbour);
  /// Where the most of at least `min_views` views agree, and at least `min_share` of them: highest first.
  std::array<DepthPeak, kPeaks> Peaks(int min_views, float min_share);

 private:
  DepthSteps steps_;
  std::vector<int> votes_, seen_;
  std::vector<float> share_;
};

}  // namespace evit
