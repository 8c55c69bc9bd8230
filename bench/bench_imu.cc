// Pre-integration, against the usual 15-state form with dense 15x15 products.
#include <Eigen/Core>

#include "bench/counters.h"
#include "common/imu/preintegration.h"
#include "tests/helpers/handheld_motion.h"

namespace evit::bench {
namespace {

constexpr int kSamples = 1000;
const ImuNoise kNoise{7e-4, 1.3e-3, 7e-6, 5.6e-5};

std::vector<ImuSample> Samples() { return test::HandheldImu(0, Utime{kSamples} * 5000, 5000); }

void Ours(benchmark::State& state) {
  Preintegration pre(Samples(), {}, kNoise);
  for (auto _ : state) {
    pre.Repropagate({{0.01, 0.02, 0.03}, {0.1, 0.2, 0.3}});
    benchmark::DoNotOptimize(pre.covariance().data());
  }
  PerSecond(state, kSamples, 1e6, 0);
}
BENCHMARK(Ours)->Name("Pre-integration, IMU samples/ours")->Unit(benchmark::kMicrosecond);

void Reference(benchmark::State& state) {
  using Matrix15 = Eigen::Matrix<double, 15, 15>;
  const std::vector<ImuSample> samples = Samples();
  for (auto _ : state) {
    Eigen::Vector3d alpha = Eigen::Vector3d::Zero(), beta = alpha;
    Eigen::Quaterniond gamma = Eigen::Quaterniond::Identity();
    Matrix15 covariance = Matrix15::Zero(), jacobian = Matrix15::Identity();
    for (std::size_t k = 1; k < samples.size(); ++k) {
      const double dt = ToSeconds(samples[k].t - samples[k - 1].t);
      const Eigen::Vector3d rate = 0.5 * (samples[k - 1].gyro + samples[k].gyro);
      const Eigen::Quaterniond next = gamma * ExpSO3(rate * dt);
      const Eigen::Matrix3d R0 = gamma.toRotationMatrix(), R1 = next.toRotationMatrix();
      const Eigen::Vector3d accel = 0.5 * (R0 * samples[k - 1].accel + R1 * samples[k].accel);
      alpha += dt * beta + 0.5 * dt * dt * accel;
      beta += dt * accel;
      gamma = next.normalized();
      Matrix15 F = Matrix15::Identity();
      F.block<3, 3>(0, 3) = dt * Eigen::Matrix3d::Identity();
      F.block<3, 3>(0, 6) = -0.25 * dt * dt * (R0 * Hat(samples[k - 1].accel) + R1 * Hat(samples[k].accel));
      F.block<3, 3>(3, 6) = -0.5 * dt * (R0 * Hat(samples[k - 1].accel) + R1 * Hat(samples[k].accel));
      F.block<3, 3>(6, 6) = ExpSO3(-rate * dt).toRotationMatrix();
      F.block<3, 3>(0, 9) = -0.25 * dt * dt * (R0 + R1);
      F.block<3, 3>(3, 9) = -0.5 * dt * (R0 + R1);
      F.block<3, 3>(6, 12) = -dt * Eigen::Matrix3d::Identity();
      Eigen::Matrix<double, 15, 18> V = Eigen::Matrix<double, 15, 18>::Zero();
      V.block<3, 3>(3, 0) = 0.5 * dt * R0;
      V.block<3, 3>(3, 6) = 0.5 * dt * R1;
      V.block<3, 3>(6, 3) = V.block<3, 3>(6, 9) = 0.5 * dt * Eigen::Matrix3d::Identity();
      V.block<3, 3>(9, 12) = V.block<3, 3>(12, 15) = dt * Eigen::Matrix3d::Identity();
      jacobian = (F * jacobian).eval();
      covariance = (F * covariance * F.transpose() + 1e-6 * V * V.transpose()).eval();
    }
    benchmark::DoNotOptimize(covariance.data());
    benchmark::DoNotOptimize(jacobian.data());
    benchmark::DoNotOptimize(alpha.data());
  }
  PerSecond(state, kSamples, 0, 0);
}
BENCHMARK(Reference)->Name("Pre-integration, IMU samples/reference")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace evit::bench
