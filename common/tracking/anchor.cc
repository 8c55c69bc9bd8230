#include "common/tracking/anchor.h"

namespace evit {

void Anchor::Start(const SE3& T_map_body) {
  state_ = {T_map_body, Eigen::Vector3d::Zero()};
  moves_ = false;
}

void Anchor::Start(const SE3& T_map_body, const Eigen::Vector3d& velocity) {
  state_ = {T_map_body, velocity};
  moves_ = true;
  dead_reckoned_ = 0;
}

void Anchor::Move(const std::vector<ImuSample>& samples, const ImuBias& bias, double gravity,
                  double max_speed) {
  constexpr Utime kLongest = 1'500'000;  // us: by then the position may be decimetres off
  const NavState moved = PropagateImu(state_, samples, bias, gravity);
  moves_ = moves_ && dead_reckoned_ < kLongest && moved.velocity.norm() <= max_speed;
  if (moves_) {
    state_ = moved;
    dead_reckoned_ += samples.back().t - samples.front().t;
  } else {
    state_.T_map_body.q = moved.T_map_body.q;
    state_.velocity.setZero();
  }
}

}  // namespace evit
