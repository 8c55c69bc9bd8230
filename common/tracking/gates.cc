#include "common/tracking/gates.h"

#include "common/text/format_text.h"

namespace evit {

bool LiesOnEvents(const AlignmentQuality& quality, double min_contrast, double significance,
                  double min_significance) {
  return quality.n_points >= kMinPoints && quality.contrast() >= min_contrast &&
         significance >= min_significance;
}

bool WithinReach(const SE3& found, const SE3& predicted, const StartRange& range) {
  constexpr double kSigmas = 4;
  return (found.p - predicted.p).norm() < kSigmas * range.position &&
         AngularDistance(found.q, predicted.q) < kSigmas * range.rotation;
}

std::string WhyImplausible(const BodyState& state, const FailureOptions& limits) {
  // Written so that what is not a number is impossible too.
  if (!(state.velocity.norm() <= limits.max_speed)) {
    return FormatText("speed of %.1f m/s is over the limit of %.1f", state.velocity.norm(), limits.max_speed);
  }
  if (!(state.bias.gyro.norm() <= limits.max_gyro_bias && state.bias.accel.norm() <= limits.max_accel_bias)) {
    return FormatText("biases too large: gyro %.3f rad/s, accel %.2f m/s^2", state.bias.gyro.norm(),
                      state.bias.accel.norm());
  }
  return "";
}

}  // namespace evit
