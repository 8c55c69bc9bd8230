// Pre-integration against closed forms, fine integration, numeric derivatives and simulated noise.
#include "common/imu/preintegration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/imu/propagation.h"
#include "tests/helpers/handheld_motion.h"

namespace evit {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;

const ImuNoise kNoise{7e-4, 1.3e-3, 7e-6, 5.6e-5};  // of the class of an XSens MTi-30

std::vector<ImuSample> Constant(const Vector3d& gyro, const Vector3d& accel, int n, Utime step) {
  std::vector<ImuSample> samples;
  for (int k = 0; k <= n; ++k) samples.push_back({k * step, gyro, accel});
  return samples;
}

// delta `a` as seen from `b`: (alpha, beta, gamma) error, right perturbation.
Vector9d Minus(const Preintegration::Delta& a, const Preintegration::Delta& b) {
  Vector9d d;
  d << a.alpha - b.alpha, a.beta - b.beta, LogSO3(b.gamma.conjugate() * a.gamma);
  return d;
}

TEST(Preintegration, ConstantAccelerationIsExact) {
  const Vector3d accel(1, -2, 9.81);
  const Preintegration pre(Constant(Vector3d::Zero(), accel, 10, 5000), {}, kNoise);
  EXPECT_NEAR(pre.dt(), 0.05, 1e-15);
  EXPECT_LT((pre.delta().alpha - 0.5 * 0.05 * 0.05 * accel).norm(), 1e-15);
  EXPECT_LT((pre.delta().beta - 0.05 * accel).norm(), 1e-15);
  EXPECT_LT(LogSO3(pre.delta().gamma).norm(), 1e-15);
}

TEST(Preintegration, ConstantTurnIsExactInRotation) {
  const Vector3d gyro(0.5, -3, 1);
  const Preintegration pre(Constant(gyro, {0, 0, 9.81}, 20, 5000), {}, kNoise);
  EXPECT_LT((LogSO3(pre.delta().gamma) - 0.1 * gyro).norm(), 1e-13);
}

TEST(Preintegration, BiasesAreSubtracted) {
  const Vector3d gyro(0.5, -1, 1), accel(1, 2, 9);
  const ImuBias bias{{0.01, -0.02, 0.03}, {0.1, 0.2, -0.3}};
  const Preintegration with(Constant(gyro + bias.gyro, accel + bias.accel, 10, 5000), bias, kNoise);
  const Preintegration without(Constant(gyro, accel, 10, 5000), {}, kNoise);
  EXPECT_LT(Minus(with.delta(), without.delta()).norm(), 1e-14);
}

// The claim of the header: at 200 Hz over 30 ms of fast hand-held motion, the first-order rule errs far more.
TEST(Preintegration, MidpointBeatsTheFirstOrderRule) {
  double midpoint = 0, first_order = 0;
  for (int k = 0; k < 100; ++k) {
    const Utime begin = Utime{40'000} * k;
    const Preintegration fine(test::HandheldImu(begin, begin + 30'000, 20), {}, kNoise);
    const std::vector<ImuSample> samples = test::HandheldImu(begin, begin + 30'000, 5000);
    const Preintegration pre(samples, {}, kNoise);
    Preintegration::Delta euler{Vector3d::Zero(), Vector3d::Zero(), Quaterniond::Identity()};
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
      const double dt = ToSeconds(samples[i + 1].t - samples[i].t);
      const Vector3d accel = euler.gamma * samples[i].accel;
      euler.alpha += dt * euler.beta + 0.5 * dt * dt * accel;
      euler.beta += dt * accel;
      euler.gamma = euler.gamma * ExpSO3(samples[i].gyro * dt);
    }
    midpoint += Minus(pre.delta(), fine.delta()).squaredNorm();
    first_order += Minus(euler, fine.delta()).squaredNorm();
  }
  midpoint = std::sqrt(midpoint / 100);
  first_order = std::sqrt(first_order / 100);
  RecordProperty("midpoint_error", std::to_string(midpoint));
  RecordProperty("first_order_error", std::to_string(first_order));
  EXPECT_LT(midpoint, 0.01 * first_order) << "midpoint " << midpoint << ", first order " << first_order;
}

TEST(Preintegration, DoesNotDependOnWhereTheMotionIsCut) {
  const std::vector<ImuSample> all = test::HandheldImu(0, 100'000, 5000);
  const Preintegration whole(all, {}, kNoise);
  const Preintegration a({all.begin(), all.begin() + 8}, {}, kNoise);
  const Preintegration b({all.begin() + 7, all.end()}, {}, kNoise);
  const auto &da = a.delta(), &db = b.delta();
  const Preintegration::Delta joined{da.alpha + da.beta * b.dt() + da.gamma * db.alpha,
                                     da.beta + da.gamma * db.beta, da.gamma * db.gamma};
  EXPECT_LT(Minus(whole.delta(), joined).norm(), 1e-14);
}

TEST(Preintegration, BiasJacobiansMatchNumericDerivatives) {
  const ImuBias bias{{0.02, -0.01, 0.03}, {0.1, -0.1, 0.05}};
  Preintegration pre(test::HandheldImu(100'000, 160'000, 5000), bias, kNoise);
  for (int k = 0; k < 6; ++k) {
    constexpr double kStep = 1e-5;
    ImuBias up = bias, down = bias;
    (k < 3 ? up.gyro[k] : up.accel[k - 3]) += kStep;
    (k < 3 ? down.gyro[k] : down.accel[k - 3]) -= kStep;
    Preintegration a = pre, b = pre;
    a.Repropagate(up);
    b.Repropagate(down);
    const Vector9d numeric = (Minus(a.delta(), pre.delta()) - Minus(b.delta(), pre.delta())) / (2 * kStep);
    const Vector9d analytic = k < 3 ? pre.d_gyro_bias().col(k) : pre.d_accel_bias().col(k - 3);
    EXPECT_LT((numeric - analytic).norm(), 1e-7) << "bias component " << k;
  }
}

TEST(Preintegration, SmallBiasChangesAreCorrectedLargeOnesAskForRepropagation) {
  Preintegration pre(test::HandheldImu(0, 60'000, 5000), {}, kNoise);
  const ImuBias small{{0.004, -0.003, 0.005}, {0.03, 0.02, -0.04}};
  EXPECT_FALSE(pre.NeedsRepropagation(small));
  const Preintegration::Delta corrected = pre.Corrected(small);
  const Vector9d size = Minus(pre.delta(), corrected);
  Preintegration again = pre;
  again.Repropagate(small);
  EXPECT_LT(Minus(again.delta(), corrected).norm(), 1e-3 * size.norm());
  EXPECT_TRUE(pre.NeedsRepropagation({{0.02, 0, 0}, Vector3d::Zero()}));
  EXPECT_TRUE(pre.NeedsRepropagation({Vector3d::Zero(), {0, 0.2, 0}}));
}

// White noise of the stated density on each reading: the spread of the terms is the stated covariance.
TEST(Preintegration, CovarianceIsTheSpreadOfNoisyIntegrations) {
  const std::vector<ImuSample> clean = test::HandheldImu(200'000, 260'000, 5000);
  const Preintegration truth(clean, {}, kNoise);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const double gyro = kNoise.gyro_density / std::sqrt(0.005);
  const double accel = kNoise.accel_density / std::sqrt(0.005);
  Preintegration::Matrix9d spread = Preintegration::Matrix9d::Zero();
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<ImuSample> noisy = clean;
    for (ImuSample& s : noisy) {
      for (int k = 0; k < 3; ++k) {
        s.gyro[k] += gyro * normal(random);
        s.accel[k] += accel * normal(random);
      }
    }
    const Vector9d d = Minus(Preintegration(noisy, {}, kNoise).delta(), truth.delta());
    spread += d * d.transpose() / kRuns;
  }
  for (int k = 0; k < 9; ++k) {  // 12 steps share 13 readings: the ends count half, so up to 10 % less
    EXPECT_NEAR(std::sqrt(spread(k, k) / truth.covariance()(k, k)), 1, 0.12) << "component " << k;
  }
  // Position and velocity errors come from the same readings: correlated as stated.
  for (int k = 0; k < 3; ++k) {
    const auto correlation = [k](const Preintegration::Matrix9d& m) {
      return m(k, k + 3) / std::sqrt(m(k, k) * m(k + 3, k + 3));
    };
    EXPECT_NEAR(correlation(spread), correlation(truth.covariance()), 0.06);
  }
}

TEST(Preintegration, ReadingsAtFullScaleAreHardlyBelieved) {
  ImuNoise noise = kNoise;
  noise.gyro_range = 8;
  noise.accel_range = 50;
  auto samples = Constant({1, 0, 0}, {0, 0, 9.81}, 6, 5000);
  const Preintegration good(samples, {}, noise);
  EXPECT_EQ(good.covariance(), Preintegration(samples, {}, kNoise).covariance());
  samples[3].gyro.y() = -8;
  const Preintegration cut_off(samples, {}, noise);
  EXPECT_GT(cut_off.covariance()(7, 7), 100 * good.covariance()(7, 7));
  samples[3].gyro.y() = 0;
  samples[3].accel.z() = 50;
  const Preintegration hit(samples, {}, noise);
  EXPECT_GT(hit.covariance()(5, 5), 100 * good.covariance()(5, 5));
  EXPECT_LT(hit.covariance()(7, 7), 2 * good.covariance()(7, 7));
}

TEST(PropagateImu, FollowsTheMotion) {
  const test::Motion begin = test::Handheld(0), end = test::Handheld(1'000'000);
  const ImuBias bias{{0.02, -0.01, 0.03}, {0.1, -0.1, 0.05}};
  std::vector<ImuSample> samples = test::HandheldImu(0, 1'000'000, 5000);
  for (ImuSample& s : samples) s.gyro += bias.gyro, s.accel += bias.accel;
  const NavState state = PropagateImu({begin.T_map_body, begin.velocity}, samples, bias, 9.81);
  EXPECT_LT((state.T_map_body.p - end.T_map_body.p).norm(), 2e-4);
  EXPECT_LT((state.velocity - end.velocity).norm(), 5e-4);
  EXPECT_LT(AngularDistance(state.T_map_body.q, end.T_map_body.q), 1e-4);
}

TEST(PropagateImu, AgreesWithPreintegration) {
  const std::vector<ImuSample> samples = test::HandheldImu(300'000, 350'000, 5000);
  const test::Motion begin = test::Handheld(300'000);
  const NavState state = PropagateImu({begin.T_map_body, begin.velocity}, samples, {}, 9.81);
  const Preintegration pre(samples, {}, kNoise);
  const Vector3d g(0, 0, -9.81);
  const double dt = pre.dt();
  const Quaterniond& q = begin.T_map_body.q;
  EXPECT_LT((state.T_map_body.p -
             (begin.T_map_body.p + dt * begin.velocity + 0.5 * dt * dt * g + q * pre.delta().alpha))
                .norm(),
            1e-13);
  EXPECT_LT((state.velocity - (begin.velocity + dt * g + q * pre.delta().beta)).norm(), 1e-13);
  EXPECT_LT(AngularDistance(state.T_map_body.q, q * pre.delta().gamma), 1e-7);
}

TEST(InterpolateImu, IsLinear) {
  const ImuSample a{1000, {0, 1, 2}, {3, 4, 5}}, b{2000, {1, 1, 1}, {0, 0, 0}};
  const ImuSample c = InterpolateImu(a, b, 1250);
  EXPECT_EQ(c.t, 1250);
  EXPECT_LT((c.gyro - Vector3d(0.25, 1, 1.75)).norm(), 1e-15);
  EXPECT_LT((c.accel - Vector3d(2.25, 3, 3.75)).norm(), 1e-15);
}

}  // namespace
}  // namespace evit
