#include "common/tracking/keyframe_need.h"

#include <algorithm>

namespace evit {
namespace {

constexpr double kRandomShare = 1.0 / 3;    // of the systematic variance
constexpr double kMostMotion = 30.0 / 640;  // of the image's width
constexpr double kLongest = 1e6;            // us

// Of the systematic to the random variance, over three axes from `first` on.
double Ratio(const KeyframeNeed& need, int first) {
  const double random = need.random.diagonal().segment<3>(first).sum();
  const double systematic = need.systematic.diagonal().segment<3>(first).sum();
  return random > 0 && systematic > 0 ? systematic / random : 0;
}

}  // namespace

Utime UsefulInterval(const KeyframeNeed& need) {
  if (need.interval <= 0 || !(need.image_speed > 0)) return 0;
  const double by_covariance =
      kRandomShare * std::min(Ratio(need, 0), Ratio(need, 3)) * static_cast<double>(need.interval);
  const double by_motion = 1e6 * kMostMotion * need.image_width / need.image_speed;
  return static_cast<Utime>(std::min({by_covariance, by_motion, kLongest}));
}

}  // namespace evit
