#include "common/imu/propagation.h"

namespace evit {

NavState PropagateImu(const NavState& state, const std::vector<ImuSample>& samples, const ImuBias& bias,
                      double gravity) {
  const Eigen::Vector3d g(0, 0, -gravity);
  NavState out = state;
  SE3& pose = out.T_map_body;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const ImuSample &a = samples[k - 1], &b = samples[k];
    const double dt = ToSeconds(b.t - a.t);
    const Eigen::Vector3d rate = 0.5 * (a.gyro + b.gyro) - bias.gyro;
    const Eigen::Quaterniond q = (pose.q * ExpSO3(rate * dt)).normalized();
    const Eigen::Vector3d accel = 0.5 * (pose.q * (a.accel - bias.accel) + q * (b.accel - bias.accel)) + g;
    pose.p += dt * out.velocity + 0.5 * dt * dt * accel;
    pose.q = q;
    out.velocity += dt * accel;
  }
  return out;
}

}  // namespace evit
