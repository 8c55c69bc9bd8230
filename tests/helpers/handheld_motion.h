#pragma once

#include <cmath>
#include <vector>

#include "common/geometry/se3.h"
#include "common/imu/imu_sample.h"

/// A smooth hand-held motion with known derivatives: up to about 1.5 m/s, 3 rad/s and 8 m/s^2.
namespace evit::test {

struct Motion {
  SE3 T_map_body;
  Eigen::Vector3d velocity, acceleration;  // m/s, m/s^2, map frame
  Eigen::Vector3d rate;                    // rad/s, body frame
};

inline Motion Handheld(Utime t) {
  const double s = ToSeconds(t);
  const Eigen::Array3d amplitude(0.30, 0.25, 0.15), frequency(4.1, 5.3, 6.7), phase(0.3, 1.1, 2.0);
  const Eigen::Array3d angle = frequency * s + phase;
  Motion m;
  m.T_map_body.p = amplitude * angle.sin();
  m.velocity = amplitude * frequency * angle.cos();
  m.acceleration = -amplitude * frequency.square() * angle.sin();
  // Turn about z, then about x: both rates are known in closed form.
  const double yaw = 0.5 * std::sin(4.3 * s), yaw_rate = 0.5 * 4.3 * std::cos(4.3 * s);
  const double roll = 0.4 * std::sin(5.9 * s + 0.7), roll_rate = 0.4 * 5.9 * std::cos(5.9 * s + 0.7);
  const Eigen::Quaterniond q_roll = ExpSO3({roll, 0, 0});
  m.T_map_body.q = ExpSO3({0, 0, yaw}) * q_roll;
  m.rate = Eigen::Vector3d(roll_rate, 0, 0) + q_roll.conjugate() * Eigen::Vector3d(0, 0, yaw_rate);
  return m;
}

/// Noiseless readings of that motion from `begin` to `end` (us, both included) every `step` us.
inline std::vector<ImuSample> HandheldImu(Utime begin, Utime end, Utime step, double gravity = 9.81) {
  std::vector<ImuSample> samples;
  for (Utime t = begin; t <= end; t += step) {
    const Motion m = Handheld(t);
    samples.push_back(
        {t, m.rate, m.T_map_body.q.conjugate() * (m.acceleration + Eigen::Vector3d(0, 0, gravity))});
  }
  return samples;
}

}  // namespace evit::test
