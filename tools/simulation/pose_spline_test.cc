#include "tools/simulation/pose_spline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/simulation/simulated_imu.h"

namespace evit::simulation {
namespace {

// A hand-held kind of motion, known in closed form.
SE3 Wave(double t) {
  const Eigen::Vector3d p(0.3 * std::sin(2.1 * t), 0.2 * std::cos(1.7 * t), 0.1 * std::sin(3.3 * t + 1));
  const Eigen::Vector3d phi(0.5 * std::sin(1.3 * t), 0.8 * std::sin(0.9 * t + 2), 0.4 * std::cos(2.2 * t));
  return {ExpSO3(phi), p};
}

Trajectory WaveTrajectory(double seconds) {
  Trajectory poses;
  for (int i = 0; i * (1 / 120.0) <= seconds; ++i) {
    const Utime t = 1'600'000'000'000'000 + static_cast<Utime>(std::llround(i * 1e6 / 120));
    poses.push_back({t, Wave(ToSeconds(t - 1'600'000'000'000'000))});
  }
  return poses;
}

TEST(SplineBasis, SumsToOneAndItsDerivativesToZero) {
  for (const double u : {0.0, 0.3, 1.0}) {
    for (int derivative = 0; derivative < 3; ++derivative) {
      double sum = 0;
      for (const double value : SplineBasis(u, derivative)) sum += value;
      EXPECT_NEAR(sum, derivative == 0 ? 1 : 0, 1e-12);
    }
  }
}

TEST(PoseSpline, GoesThroughASmoothMotion) {
  const Trajectory poses = WaveTrajectory(3);
  const PoseSpline spline = PoseSpline::Fit(poses, 0.033);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SE3 pose = spline.Pose(poses[i].t);
    EXPECT_LT((pose.p - poses[i].pose.p).norm(), 2e-5) << i;
    EXPECT_LT(AngularDistance(pose.q, poses[i].pose.q), 1e-4) << i;
  }
}

TEST(PoseSpline, DerivativesAreThoseOfItsPoses) {
  const PoseSpline spline = PoseSpline::Fit(WaveTrajectory(3), 0.033);
  constexpr Utime kStep = 1000;
  const double h = ToSeconds(kStep);
  for (Utime t = spline.begin() + 5 * kStep; t + kStep < spline.end(); t += 37'001) {
    const PoseSpline::Sample a = spline.Evaluate(t - kStep), b = spline.Evaluate(t),
                             c = spline.Evaluate(t + kStep);
    EXPECT_LT(((c.pose.p - a.pose.p) / (2 * h) - b.velocity).norm(), 1e-4);
    EXPECT_LT(((c.velocity - a.velocity) / (2 * h) - b.acceleration).norm(), 1e-2);
    EXPECT_LT((LogSO3(a.pose.q.conjugate() * c.pose.q) / (2 * h) - b.rate).norm(), 1e-4);
  }
}

TEST(PoseSpline, AccelerationHasNoStepsAtKnots) {
  const PoseSpline spline = PoseSpline::Fit(WaveTrajectory(3), 0.033);
  for (int knot = 5; knot < 80; ++knot) {
    const Utime t = spline.begin() + Utime{knot} * 33'000;
    const Eigen::Vector3d step = spline.Evaluate(t + 1).acceleration - spline.Evaluate(t - 1).acceleration;
    EXPECT_LT(step.norm(), 1e-3);
  }
}

TEST(PoseSpline, BridgesAHole) {
  Trajectory poses = WaveTrajectory(3);
  poses.erase(poses.begin() + 150, poses.begin() + 180);  // 0.25 s
  const PoseSpline spline = PoseSpline::Fit(poses, 0.033);
  EXPECT_LT((spline.Pose(spline.begin() + 1'375'000).p - Wave(1.375).p).norm(), 0.02);
}

TEST(PoseSpline, MovedIsSeenFromAnotherFrame) {
  const PoseSpline spline = PoseSpline::Fit(WaveTrajectory(2), 0.033);
  const SE3 T(ExpSO3(Eigen::Vector3d(0.1, -2, 0.7)), Eigen::Vector3d(3, -1, 2));
  const PoseSpline moved = spline.Moved(T);
  const Utime t = spline.begin() + 987'654;
  const PoseSpline::Sample a = spline.Evaluate(t), b = moved.Evaluate(t);
  EXPECT_LT(((T * a.pose).p - b.pose.p).norm(), 1e-9);
  EXPECT_LT(AngularDistance((T * a.pose).q, b.pose.q), 1e-9);
  EXPECT_LT((a.rate - b.rate).norm(), 1e-9);
  EXPECT_LT((T.q * a.acceleration - b.acceleration).norm(), 1e-7);
}

TEST(PoseSpline, InvalidTrajectoriesAreRejected) {
  EXPECT_THROW(PoseSpline::Fit(Trajectory(5), 0.033), std::runtime_error);
  Trajectory poses = WaveTrajectory(1);
  std::swap(poses[10], poses[11]);
  EXPECT_THROW(PoseSpline::Fit(poses, 0.033), std::runtime_error);
}

// The readings, integrated, give the motion back: gravity's sign, frames and biases are right.
TEST(SimulatedImu, IntegratesToTheTruth) {
  const PoseSpline spline = PoseSpline::Fit(WaveTrajectory(3), 0.033);
  Rig rig;
  rig.imu_rate_hz = 200;
  ImuSettings settings;
  settings.noise_factor = 0;
  const SimulatedImu imu = SimulateImu(spline, rig, settings, spline.begin(), spline.end(), 3);
  EXPECT_NEAR(imu.biases[0].accel.norm(), 0.06, 1e-9);
  EXPECT_NEAR(imu.biases[0].gyro.norm(), 0.006, 1e-9);
  for (std::size_t start = 20; start + 100 < imu.samples.size(); start += 90) {
    const PoseSpline::Sample first = spline.Evaluate(imu.samples[start].t);
    SE3 pose = first.pose;
    Eigen::Vector3d velocity = first.velocity;
    for (std::size_t k = start; k < start + 100; ++k) {  // 0.5 s
      const ImuSample &a = imu.samples[k], &b = imu.samples[k + 1];
      const double dt = ToSeconds(b.t - a.t);
      const Eigen::Quaterniond q = pose.q * ExpSO3((0.5 * (a.gyro + b.gyro) - imu.biases[k].gyro) * dt);
      const Eigen::Vector3d accel =
          0.5 * (pose.q * (a.accel - imu.biases[k].accel) + q * (b.accel - imu.biases[k].accel)) -
          Eigen::Vector3d(0, 0, rig.gravity);
      pose = SE3(q.normalized(), pose.p + velocity * dt + 0.5 * accel * dt * dt);
      velocity += accel * dt;
    }
    const SE3 truth = spline.Pose(imu.samples[start + 100].t);
    EXPECT_LT((pose.p - truth.p).norm(), 5e-4);
    EXPECT_LT(AngularDistance(pose.q, truth.q), 2e-4);
  }
}

TEST(SimulatedImu, NoiseHasTheRigsDensity) {
  const PoseSpline spline = PoseSpline::Fit(WaveTrajectory(30), 0.1);
  Rig rig;
  rig.imu_rate_hz = 200;
  rig.imu_noise = {7e-4, 1.3e-3, 0, 0};
  ImuSettings settings;
  const SimulatedImu noisy = SimulateImu(spline, rig, settings, spline.begin(), spline.end(), 3);
  settings.noise_factor = 0;
  const SimulatedImu clean = SimulateImu(spline, rig, settings, spline.begin(), spline.end(), 3);
  ASSERT_EQ(noisy.samples.size(), clean.samples.size());
  double gyro = 0, accel = 0;
  for (std::size_t i = 0; i < noisy.samples.size(); ++i) {
    gyro += (noisy.samples[i].gyro - clean.samples[i].gyro).squaredNorm();
    accel += (noisy.samples[i].accel - clean.samples[i].accel).squaredNorm();
  }
  const double n = 3.0 * static_cast<double>(noisy.samples.size());
  EXPECT_NEAR(std::sqrt(gyro / n), 7e-4 * std::sqrt(200), 0.03 * 7e-4 * std::sqrt(200));
  EXPECT_NEAR(std::sqrt(accel / n), 1.3e-3 * std::sqrt(200), 0.03 * 1.3e-3 * std::sqrt(200));
}

}  // namespace
}  // namespace evit::simulation
