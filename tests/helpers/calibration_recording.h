#pragma once

#include <functional>
#include <random>

#include "common/calibration/camera_imu_batch.h"
#include "tests/helpers/handheld_motion.h"

/// A synthetic recording: a rig in motion, its IMU's samples and its camera's poses in a map.
namespace evit::test {

/// Turns about all three axes, and leans by up to `lean` rad more, slowly, about the level ones: what the
/// accelerometer's bias and the direction of gravity do differs only where the body leans. (The body's x axis
/// of Handheld() always stays level.)
inline Motion Turning(Utime t, double lean) {
  Motion m = Handheld(t);
  const double s = ToSeconds(t);
  const double yaw = 0.5 * std::sin(4.3 * s), yaw_rate = 0.5 * 4.3 * std::cos(4.3 * s);
  const double pitch = 0.4 * std::sin(3.7 * s + 1.9) + lean * std::sin(1.3 * s),
               pitch_rate = 0.4 * 3.7 * std::cos(3.7 * s + 1.9) + lean * 1.3 * std::cos(1.3 * s);
  const double roll = 0.4 * std::sin(5.9 * s + 0.7) + lean * std::sin(1.7 * s + 0.5),
               roll_rate = 0.4 * 5.9 * std::cos(5.9 * s + 0.7) + lean * 1.7 * std::cos(1.7 * s + 0.5);
  const Eigen::Quaterniond q_pitch = ExpSO3({0, pitch, 0}), q_roll = ExpSO3({roll, 0, 0});
  m.T_map_body.q = ExpSO3({0, 0, yaw}) * q_pitch * q_roll;
  m.rate = Eigen::Vector3d(roll_rate, 0, 0) +
           q_roll.conjugate() *
               (Eigen::Vector3d(0, pitch_rate, 0) + q_pitch.conjugate() * Eigen::Vector3d(0, 0, yaw_rate));
  return m;
}

/// Hand-held, to 23 deg this way and that: the accelerometer's bias and the tilt of the map show weakly.
inline Motion Lively(Utime t) { return Turning(t, 0); }

/// As one moves a rig to calibrate it, to 60 deg: all is observable.
inline Motion Leaning(Utime t) { return Turning(t, 0.65); }

struct Recording {
  Rig rig;  // the true one
  ImuBias bias;
  Eigen::Vector2d tilt{0, 0};
  double seconds = 10;
  double imu_noise = 1;   // of the rig's densities
  double pose_noise = 1;  // of 1 mm and 1 mrad, white, and 2 mm and 1 mrad that wander over a second
  double outliers = 0;    // 0..1: share of poses that are 10 cm and 0.2 rad off
  unsigned seed = 1;
  std::function<Motion(Utime)> motion = Leaning;

  Recording() {
    rig.T_body_camera = {ExpSO3({1.2, -1.2, 1.25}), {0.129, 0.079, 0.025}};
    rig.camera_time_offset = 3'000;
    rig.camera.fx = 330;
    rig.imu_noise.gyro_density = 0.00073;
    rig.imu_noise.accel_density = 0.0013;
    rig.imu_noise.gyro_random_walk = 7e-6;
    rig.imu_noise.accel_random_walk = 5.6e-5;
    rig.imu_rate_hz = 200;
    bias.gyro = {0.004, -0.003, 0.005};
    bias.accel = {0.05, -0.04, 0.02};
  }

  /// 200 Hz.
  std::vector<ImuSample> Imu() const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto noise = [&](double density) -> Eigen::Vector3d {
      return Eigen::Vector3d::NullaryExpr(
          [&] { return imu_noise * density * std::sqrt(200.0) * normal(random); });
    };
    std::vector<ImuSample> samples;
    for (Utime t = 0; t <= static_cast<Utime>(seconds * 1e6); t += 5'000) {
      const Motion m = motion(t);
      const Eigen::Vector3d force =
          m.T_map_body.q.conjugate() * (m.acceleration + Eigen::Vector3d(0, 0, rig.gravity));
      const Eigen::Vector3d n_gyro = noise(rig.imu_noise.gyro_density);
      const Eigen::Vector3d n_accel = noise(rig.imu_noise.accel_density);
      samples.push_back({t, m.rate + bias.gyro + n_gyro, force + bias.accel + n_accel});
    }
    return samples;
  }

  /// T_map_camera, 100 Hz, stamped by the camera's clock.
  Trajectory Camera() const {
    std::mt19937 random(seed + 1000);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto draw = [&](double sigma) -> Eigen::Vector3d {
      return Eigen::Vector3d::NullaryExpr([&] { return sigma * normal(random); });
    };
    const SE3 T_map_upright{ExpSO3({tilt.x(), tilt.y(), 0}), Eigen::Vector3d::Zero()};
    Eigen::Vector3d slow_p = Eigen::Vector3d::Zero(), slow_r = slow_p;
    const double stay = std::exp(-0.01), fresh = std::sqrt(1 - stay * stay);
    Trajectory camera;
    for (Utime t = 12'345; t <= static_cast<Utime>(seconds * 1e6); t += 10'000) {
      slow_p = stay * slow_p + fresh * draw(2e-3);
      slow_r = stay * slow_r + fresh * draw(1e-3);
      SE3 pose = T_map_upright * motion(t).T_map_body * rig.T_body_camera;
      const Eigen::Vector3d white_p = draw(1e-3), white_r = draw(1e-3);
      pose.p += pose_noise * (slow_p + white_p);
      pose.q = pose.q * ExpSO3(pose_noise * (slow_r + white_r));
      if (uniform(random) < outliers)
        pose = pose.Plus((Eigen::Matrix<double, 6, 1>() << draw(0.1), draw(0.2)).finished());
      camera.push_back({t - rig.camera_time_offset, pose});
    }
    return camera;
  }

  /// The rig as a user has it: off by 1.8 deg, 2.6 cm and 5 ms, or `times` as much.
  Rig Wrong(double times = 1) const {
    Rig wrong = rig;
    Eigen::Matrix<double, 6, 1> off;
    off << 0.015, -0.015, 0.015, 0.018, -0.018, 0.018;
    wrong.T_body_camera = wrong.T_body_camera.Plus(times * off);
    wrong.camera_time_offset += std::llround(times * 5'000);
    return wrong;
  }
};

/// Turns about the vertical only, and walks about.
inline Motion YawOnly(Utime t) {
  Motion m = Handheld(t);
  const double s = ToSeconds(t);
  m.T_map_body.q = ExpSO3({0, 0, 0.5 * std::sin(4.3 * s)});
  m.rate = {0, 0, 0.5 * 4.3 * std::cos(4.3 * s)};
  return m;
}

/// Hardly moves: 2 cm/s and 0.02 rad/s.
inline Motion Creeping(Utime t) {
  Motion m;
  const double s = 0.5 * ToSeconds(t);
  m.T_map_body = {ExpSO3({0.04 * std::sin(s), 0, 0}), {0.04 * std::sin(s), 0, 0}};
  m.velocity = {0.02 * std::cos(s), 0, 0};
  m.acceleration = {-0.01 * std::sin(s), 0, 0};
  m.rate = {0.02 * std::cos(s), 0, 0};
  return m;
}

}  // namespace evit::test
