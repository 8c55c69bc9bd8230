#include "tools/simulation/simulated_imu.h"

#include <array>
#include <cmath>

#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

// Some sines of equal strength and chance frequency for each axis: narrow lines, as motors, steps and a
// mount's own modes make them.
class Vibration {
 public:
  Vibration(const ImuSettings& settings, std::uint64_t seed) : settings_(settings) {
    Random random(seed, 0x71B2A);
    for (Line& line : lines_) {
      line.rate = 6.283185307179586 * random.Uniform(20, 90);
      for (double& phase : line.phases) phase = random.Uniform(0, 6.283185307179586);
    }
  }
  void Add(double seconds, ImuSample* sample) const {
    const double one = std::sqrt(2.0 / kLines);
    for (const Line& line : lines_) {
      for (int axis = 0; axis < 3; ++axis) {
        sample->accel[axis] +=
            settings_.vibration_accel * one * std::sin(line.rate * seconds + line.phases[axis]);
        sample->gyro[axis] +=
            settings_.vibration_gyro * one * std::sin(line.rate * seconds + line.phases[3 + axis]);
      }
    }
  }

 private:
  static constexpr int kLines = 8;
  struct Line {
    double rate = 0;  // rad/s
    std::array<double, 6> phases{};
  };
  ImuSettings settings_;
  std::array<Line, kLines> lines_;
};

}  // namespace

SimulatedImu SimulateImu(const PoseSpline& motion, const Rig& rig, const ImuSettings& settings, Utime begin,
                         Utime end, std::uint64_t seed) {
  Random random(seed, 0x1A0);
  const double dt = 1 / rig.imu_rate_hz, root = std::sqrt(dt), factor = settings.noise_factor;
  const Eigen::Vector3d gravity(0, 0, -rig.gravity);
  const Vibration vibration(settings, seed);
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
    vibration.Add(k * dt, &sample);
    imu.samples.push_back(sample);
    imu.biases.push_back(bias);
    bias.gyro += factor * rig.imu_noise.gyro_random_walk * root * random.GaussianVector();
    bias.accel += factor * rig.imu_noise.accel_random_walk * root * random.GaussianVector();
  }
  return imu;
}

}  // namespace evit::simulation
