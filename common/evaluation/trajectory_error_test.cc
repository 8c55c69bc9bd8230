// Errors of trajectories whose error is known.
#include "common/evaluation/trajectory_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace evit {
namespace {

// Ten seconds of a wavy walk, 100 Hz.
Trajectory Walk() {
  Trajectory t;
  for (int k = 0; k <= 1000; ++k) {
    const double s = 0.01 * k;
    t.push_back({1'000'000'000 + k * 10'000,
                 {ExpSO3({0.3 * std::sin(s), 0.2 * std::cos(2 * s), 0.5 * s}),
                  {std::sin(s), std::cos(1.3 * s), 0.2 * s}}});
  }
  return t;
}

Trajectory Moved(const Trajectory& t, const SE3& by) {
  Trajectory out = t;
  for (StampedPose& s : out) s.pose = by * s.pose;
  return out;
}

TEST(AbsoluteError, OfTheTruthItselfIsZero) {
  for (const auto alignment : {Alignment::kNone, Alignment::kFirstPair, Alignment::kUmeyama}) {
    const TrajectoryError e = AbsoluteError(Walk(), Walk(), alignment);
    EXPECT_EQ(e.n_pairs, 1001);
    EXPECT_LT(e.position_rmse, 1e-9);
    EXPECT_LT(e.orientation_rmse, 1e-7);
    EXPECT_DOUBLE_EQ(e.reached, 1);
  }
}

TEST(AbsoluteError, ARigidMoveCountsWithoutAlignmentOnly) {
  const SE3 by(ExpSO3({0, 0, 0.1}), {0.3, 0.4, 0});
  const Trajectory estimate = Moved(Walk(), by);
  EXPECT_NEAR(AbsoluteError(Walk(), estimate, Alignment::kNone).orientation_rmse, 0.1, 1e-9);
  EXPECT_GT(AbsoluteError(Walk(), estimate, Alignment::kNone).position_rmse, 0.3);
  EXPECT_LT(AbsoluteError(Walk(), estimate, Alignment::kFirstPair).position_rmse, 1e-9);
  EXPECT_LT(AbsoluteError(Walk(), estimate, Alignment::kUmeyama).position_rmse, 1e-9);
  const TrajectoryError shifted =
      AbsoluteError(Walk(), Moved(Walk(), {{1, 0, 0, 0}, {0.03, 0.04, 0}}), Alignment::kNone);
  EXPECT_NEAR(shifted.position_rmse, 0.05, 1e-12);
  EXPECT_NEAR(shifted.position_max, 0.05, 1e-12);
}

// The first pair's own error spoils the whole of an alignment by it (a habit of the field: the paper's
// protocol).
TEST(AbsoluteError, FirstPairAlignmentCarriesTheFirstPairsError) {
  Trajectory estimate = Walk();
  estimate.front().pose.p.x() += 0.1;
  EXPECT_NEAR(AbsoluteError(Walk(), estimate, Alignment::kFirstPair).position_rmse, 0.1, 1e-3);
  EXPECT_LT(AbsoluteError(Walk(), estimate, Alignment::kUmeyama).position_rmse, 0.004);
}

// With independent noise of s per axis the RMSE is sqrt(3) s, and no other rigid move fits better than
// Umeyama.
TEST(AbsoluteError, NoiseOfKnownSizeAndUmeyamaIsTheBestFit) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0, 0.01);
  Trajectory estimate = Moved(Walk(), {ExpSO3({0.2, -0.4, 1}), {3, 4, 5}});
  for (StampedPose& s : estimate) s.pose.p += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const double best = AbsoluteError(Walk(), estimate, Alignment::kUmeyama).position_rmse;
  EXPECT_NEAR(best, std::sqrt(3) * 0.01, 5e-4);
  EXPECT_LE(best, AbsoluteError(Walk(), estimate, Alignment::kFirstPair).position_rmse);
  // On a straight line the rotation about it is free; the fit must still be a rotation, not a mirror image.
  Trajectory line, flat;
  for (int k = 0; k < 100; ++k) {
    line.push_back({Utime{k} * 10'000, {Eigen::Quaterniond::Identity(), {0.1 * k, 0, 0}}});
    flat.push_back({Utime{k} * 10'000, {Eigen::Quaterniond::Identity(), {0, 0.1 * k, 0}}});
  }
  EXPECT_LT(AbsoluteError(line, flat, Alignment::kUmeyama).position_rmse, 1e-9);
}

TEST(AbsoluteError, TruthIsInterpolatedAtTheEstimatesStamps) {
  Trajectory estimate;
  for (int k = 0; k < 900; ++k) {
    const Utime t = 1'000'000'000 + k * 10'000 + 3'700;
    SE3 pose;
    ASSERT_TRUE(PoseAt(Walk(), t, &pose));
    estimate.push_back({t, pose});
  }
  EXPECT_LT(AbsoluteError(Walk(), estimate, Alignment::kNone).position_rmse, 1e-12);
}

TEST(Reached, AHalfTrajectoryIsHalfAndItsLaterMilestonesAreNotReached) {
  Trajectory half = Walk();
  half.resize(501);
  EXPECT_NEAR(AbsoluteError(Walk(), half, Alignment::kNone).reached, 0.5, 1e-6);
  EXPECT_EQ(MilestoneError(Walk(), half, Alignment::kNone, 0.3).n_pairs, 301);
  EXPECT_EQ(MilestoneError(Walk(), half, Alignment::kNone, 0.5).n_pairs, 501);
  EXPECT_EQ(MilestoneError(Walk(), half, Alignment::kNone, 1.0).n_pairs, 0);
  EXPECT_EQ(AbsoluteError(Walk(), {}, Alignment::kNone).n_pairs, 0);
  EXPECT_EQ(MilestoneError({}, half, Alignment::kNone, 0.3).n_pairs, 0);
}

TEST(RelativeError, SeesDriftAndNotARigidMove) {
  EXPECT_LT(RelativeError(Walk(), Moved(Walk(), {ExpSO3({1, 2, 0}), {5, 6, 7}}), 1'000'000).position_rmse,
            1e-9);
  Trajectory drifting = Walk();
  for (StampedPose& s : drifting) s.pose.p.z() += 0.02 * ToSeconds(s.t - drifting.front().t);
  const TrajectoryError e = RelativeError(Walk(), drifting, 1'000'000);
  EXPECT_NEAR(e.position_rmse, 0.02, 1e-6);  // 2 cm for each second
  EXPECT_EQ(e.n_pairs, 901);
}

// The numbers are evo_definitions.py's: positions, rotations, the largest of each.
TEST(TrajectoryError, AgreesWithEvosDefinitionsToTheDigitsPrinted) {
  Trajectory truth, estimate;
  const Eigen::Quaterniond turn = ExpSO3({0.2, -0.4, 1});
  for (int k = 0; k <= 400; ++k) {
    const double s = 0.02 * k;
    const Eigen::Quaterniond q = ExpSO3({0.3 * std::sin(s), 0.2 * std::cos(2 * s), 0.5 * s});
    const Eigen::Vector3d p(std::sin(s), std::cos(1.3 * s), 0.2 * s),
        e = 0.01 * Eigen::Vector3d(std::sin(7 * s), std::cos(5 * s), std::sin(3 * s)),
        d = 0.01 * Eigen::Vector3d(std::cos(9 * s), std::sin(11 * s), std::cos(4 * s));
    truth.push_back({Utime{20'000} * k, {q, p}});
    estimate.push_back(
        {Utime{20'000} * k, {turn * q * ExpSO3(e), 0.97 * (turn * (p + d)) + Eigen::Vector3d(3, 4, 5)}});
  }
  const auto expect = [](const TrajectoryError& error, const std::array<double, 4>& expected) {
    EXPECT_NEAR(error.position_rmse, expected[0], 1e-10);
    EXPECT_NEAR(error.orientation_rmse, expected[1], 1e-10);
    EXPECT_NEAR(error.position_max, expected[2], 1e-10);
    EXPECT_NEAR(error.orientation_max, expected[3], 1e-10);
  };
  expect(AbsoluteError(truth, estimate, Alignment::kNone),
         {6.964211106878, 1.095736002607, 7.944729769403, 1.107314245991});
  expect(AbsoluteError(truth, estimate, Alignment::kUmeyama),
         {0.034932460142, 0.012261863566, 0.057991051250, 0.017079317853});
  expect(AbsoluteError(truth, estimate, Alignment::kScaled),
         {0.012259546389, 0.012261863566, 0.017518255462, 0.017079317853});
  expect(RelativeError(truth, estimate, 20'000),
         {0.002148602349, 0.001289264842, 0.003620108562, 0.001817746301});
  expect(RelativeError(truth, estimate, 1'000'000),
         {0.041099982216, 0.017722622354, 0.067232861169, 0.024083885084});
}

}  // namespace
}  // namespace evit
