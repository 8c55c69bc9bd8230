#include "common/evaluation/trajectory_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/evaluation/trajectory_error.h"

namespace evit {
namespace {

using ::testing::HasSubstr;

// Three seconds of a curve at 40 Hz, `x` aside.
Trajectory Curve(double x) {
  Trajectory out;
  for (int k = 0; k <= 120; ++k) {
    const double s = 0.025 * k;
    out.push_back({1'000'000'000 + Utime{25'000} * k,
                   {ExpSO3({0.3 * std::sin(2 * s), 0, s}), {x + std::sin(4 * s), std::cos(5 * s), 0.1 * s}}});
  }
  return out;
}

Trajectory EveryNth(const Trajectory& all, int n) {
  Trajectory out;
  for (std::size_t k = 0; k < all.size(); k += n) out.push_back(all[k]);
  return out;
}

TEST(TrajectoryPairs, SlowTruthIsScoredAtItsOwnStamps) {
  for (const auto& [every, pairs] :
       {std::pair(8, 16), std::pair(10, 13), std::pair(40, 4)}) {  // 5, 4 and 1 Hz
    const Trajectory truth = EveryNth(Curve(0), every);
    const TrajectoryError error = AbsoluteError(truth, Curve(0.01), Alignment::kNone);
    EXPECT_EQ(error.n_pairs, pairs) << every;
    EXPECT_NEAR(error.position_rmse, 0.01, 1e-9) << every;
    EXPECT_TRUE(error.scored());
  }
  EXPECT_THAT(UnscoredText(EveryNth(Curve(0), 10), Curve(0)), HasSubstr("truth only every 0.25 s"));
  // The estimate's stamps need not meet the truth's.
  Trajectory shifted;
  for (const StampedPose& s : EveryNth(Curve(0), 10)) shifted.push_back({s.t + 7'000, s.pose});
  EXPECT_EQ(AbsoluteError(shifted, Curve(0), Alignment::kNone).n_pairs, 12);
}

TEST(TrajectoryPairs, DenseTruthIsInterpolated) {
  const auto pairs = MakePairs(Curve(0), EveryNth(Curve(0), 10));
  EXPECT_EQ(pairs.size(), 13U);
  EXPECT_EQ(UnscoredText(Curve(0), Curve(0)), "");
}

TEST(TrajectoryPairs, SaysWhatIsNotScoredAndWhy) {
  Trajectory truth = Curve(0);
  truth.erase(truth.begin() + 40, truth.begin() + 60);  // 0.5 s
  truth.erase(truth.begin(), truth.begin() + 3);
  truth.pop_back();
  const std::string text = UnscoredText(truth, Curve(0));
  EXPECT_THAT(text,
              HasSubstr("24 poses not scored: 3 before the truth begins, 1 after it ends, 20 in holes of the "
                        "truth longer than 0.20 s"));
  EXPECT_EQ(MakePairs(truth, Curve(0)).size(), 97U);
}

TEST(TrajectoryPairs, TooFewPairsGiveNoFigure) {
  const Trajectory truth = {Curve(0)[0], Curve(0)[80]};
  const TrajectoryError error = AbsoluteError(truth, Curve(0.01), Alignment::kNone);
  EXPECT_FALSE(error.scored());
  EXPECT_EQ(error.position_rmse, 0);
  EXPECT_THAT(TooFewPairsText(truth, Curve(0.01)), HasSubstr("only 2 pairs"));
  Trajectory later = Curve(0);
  for (StampedPose& s : later) s.t += 10'000'000;
  EXPECT_THAT(TooFewPairsText(Curve(0), later), HasSubstr("do not overlap"));
}

TEST(TrajectoryPairs, RelativeErrorOfSlowTruth) {
  const TrajectoryError error = RelativeError(EveryNth(Curve(0), 10), Curve(0), kMicrosPerSecond);
  EXPECT_GE(error.n_pairs, 9);
  EXPECT_LT(error.position_rmse, 1e-9);
}

// Positions on a line leave the turn about it open: an alignment that was found was one of many.
TEST(UmeyamaAlignment, HasNoOrientationErrorOnALineOrASpotAndNoFigureOfTwoPairs) {
  Trajectory line, still, bent;
  for (int k = 0; k <= 100; ++k) {
    const Utime t = Utime{50'000} * k;
    const double wobble = 0.002 * std::sin(1.7 * k);
    line.push_back({t, {Eigen::Quaterniond::Identity(), {0.02 * k, wobble, 0}}});
    still.push_back({t, {Eigen::Quaterniond::Identity(), {wobble, 0.002 * std::cos(2.3 * k), 1}}});
    bent.push_back({t, {Eigen::Quaterniond::Identity(), {0.02 * k, 0.2 * std::sin(0.1 * k), 0}}});
  }
  for (const Trajectory* flat : {&line, &still}) {
    for (const auto& [truth, estimate] : {std::pair(*flat, *flat), {*flat, bent}, {bent, *flat}}) {
      const TrajectoryError error = AbsoluteError(truth, estimate, Alignment::kUmeyama);
      EXPECT_TRUE(error.scored());
      EXPECT_FALSE(error.oriented);
    }
    EXPECT_TRUE(AbsoluteError(*flat, *flat, Alignment::kFirstPair).oriented);
  }
  EXPECT_TRUE(AbsoluteError(bent, bent, Alignment::kUmeyama).oriented);
  EXPECT_FALSE(AbsoluteError({bent[0], bent[50]}, {bent[0], bent[50]}, Alignment::kUmeyama).scored());
  EXPECT_TRUE(AbsoluteError(line, line, Alignment::kScaled).scored());
  EXPECT_FALSE(AbsoluteError(still, still, Alignment::kScaled).scored());
}

// Turned about its own line by any angle, the line lies on itself: the position error is one figure.
TEST(UmeyamaAlignment, OfALineLeavesItsPositionError) {
  Trajectory truth, estimate;
  const SE3 move(Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized())), {4, 5, 6});
  for (int k = 0; k <= 100; ++k) {
    const Eigen::Vector3d p(0.02 * k, 0, 0);
    truth.push_back({Utime{50'000} * k, {Eigen::Quaterniond::Identity(), p}});
    const Eigen::Vector3d off(0, k % 2 == 0 ? 0.003 : -0.003, 0);
    estimate.push_back({Utime{50'000} * k, move * SE3(Eigen::Quaterniond::Identity(), p + off)});
  }
  EXPECT_NEAR(AbsoluteError(truth, estimate, Alignment::kUmeyama).position_rmse, 0.003, 1e-4);
}

}  // namespace
}  // namespace evit
