#include "common/imu/gentle_start.h"

namespace evit {

void GentleStart::Begin(const Eigen::Vector3d& force) {
  at_rest_ = force;
  speed_.setZero();
}

bool GentleStart::Seen(const Eigen::Vector3d& force, double seconds) {
  // An accelerometer that warms up by 0.02 m/s^2 in a minute adds up to 0.03 m/s; a start of 0.04 m/s^2
  // passes the limit after four seconds.
  constexpr double kForgets = 5, kFollows = 20;  // s
  constexpr double kMostSpeed = 0.1;             // m/s
  const Eigen::Vector3d more = force - at_rest_;
  speed_ += seconds * (more - speed_ / kForgets);
  at_rest_ += seconds / kFollows * more;
  return speed_.norm() > kMostSpeed;
}

}  // namespace evit
