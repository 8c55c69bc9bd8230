#include "services/window_optimizer/imu_rate_pose.h"

namespace evit {

void ImuRatePose::StartFrom(Utime t, const BodyState& state) {
  t_ = t;
  state_ = {state.T_map_body, state.velocity};
  bias_ = state.bias;
}

std::optional<NavState> ImuRatePose::At(Utime t, const ImuHistory& history) const {
  if (t_ == 0) return std::nullopt;
  const std::vector<ImuSample> samples = history.Between(t_, t);
  if (samples.empty()) return std::nullopt;
  return PropagateImu(state_, samples, bias_, gravity_);
}

}  // namespace evit
