#include "tools/simulation/simulated_imu.h"

#include <cmath>

#include "tools/simulation/random.h"

namespace evit::simulation {

SimulatedImu SimulateImu(const PoseSpline& motion, const Rig& rig, const ImuSettings& settings, Utime begin,
                         Utime end, std::uint64_t seed) {
  Random random(seed, 0x1A0);
  const double dt = 1 / rig.imu_rate_hz, root = std::sqrt(dt), factor = settings.noise_factor;
  const Eigen::Vector3d gravity(0, 0, -rig.gravity);
  ImuBias bias;
  bias.gyro = settings.gyro_bias * random.Direction();
  bias.accel = settings.accel_bias * random.Direction();
  SimulatedImu imu;
  for (int k = 0;; ++k) {
    const Utime t = begin + static_cast<Utime>(std::llround(k * dt * 1e6));
    if (t > end) break;
    const PoseSpline::Sample state = motion.Evaluate(t);
    ImuSample sample;
    sample.t = t;
    sample.gyro =
        state.rate + bias.gyro + factor * rig.imu_noise.gyro_density / root * random.GaussianVector();
    sample.accel = state.pose.q.conjugate() * (state.acceleration - gravity) + bias.accel +
                   factor * rig.imu_noise.accel_density / root * random.GaussianVector();
    imu.samples.push_back(sample);
    imu.biases.push_back(bias);
    bias.gyro += factor * rig.imu_noise.gyro_random_walk * root * random.GaussianVector();
    bias.accel += factor * rig.imu_noise.accel_random_walk * root * random.GaussianVector();
  }
  return imu;
}

}  // namespace evit::simulation
