#include "common/localization/motion_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/localization/scale_watch.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

constexpr Utime kStep = 50'000, kBegin = 1'000'000;

// A hand-held body in a map that is `scale` times too large; poses as noisy as those of single keyframes.
struct Recorded {
  std::vector<FollowedPlace::Step> steps;
  std::vector<ImuSample> imu;

  Recorded(double scale, double seconds, double amplitude = 1) {
    synthetic::Motion motion;
    motion.amplitude *= amplitude;
    std::mt19937 rng(3);
    std::normal_distribution<double> noise(0, 1);
    const Utime end = kBegin + static_cast<Utime>(1e6 * seconds);
    // A biased gyro and accelerometer, and a map that does not stand quite upright.
    imu = motion.Samples(kBegin, end, {{0.004, -0.006, 0.005}, {0.08, -0.05, 0.06}});
    const Eigen::Quaterniond tilt = ExpSO3({0.01, -0.01, 0.7});
    for (Utime t = kBegin; t <= end; t += kStep) {
      const SE3 truth = motion.State(ToSeconds(t)).T_map_body;
      const auto random = [&](double sigma) {
        return Eigen::Vector3d(sigma * noise(rng), sigma * noise(rng), sigma * noise(rng));
      };
      steps.push_back(
          {t, {tilt * truth.q * ExpSO3(random(0.002)), tilt * (scale * truth.p) + random(0.002)}, 8});
    }
  }
};

TEST(MotionFitTest, TellsHowLargeAMapIs) {
  for (const double scale : {0.67, 1.0, 1.5}) {
    const Recorded recorded(scale, 4);
    const std::optional<MotionFit> fit = FitMotion(recorded.steps, recorded.imu, 9.81);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->scale, scale, 0.1);
    EXPECT_LT(fit->scale_sigma, 0.12);
    EXPECT_LT(fit->misfit, 0.006);
    EXPECT_EQ(fit->Disagrees(), scale != 1);
  }
}

// As on real recordings: a narrow view takes a centimetre sideways for a turn, the farther the more it has
// moved.
TEST(MotionFitTest, ErrorsThatGoWithTheMotionAreNoWrongSize) {
  for (const double seconds : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0}) {
    Recorded recorded(1, seconds, 0.1);
    const Eigen::Vector3d first = recorded.steps.front().T_map_body.p;
    double farthest = 0;
    for (const FollowedPlace::Step& step : recorded.steps)
      farthest = std::max(farthest, (step.T_map_body.p - first).norm());
    for (FollowedPlace::Step& step : recorded.steps)
      step.T_map_body.p -= 0.01 / farthest * (step.T_map_body.p - first);
    const std::optional<MotionFit> fit = FitMotion(recorded.steps, recorded.imu, 9.81);
    ASSERT_TRUE(fit);
    EXPECT_FALSE(fit->Disagrees()) << seconds << " s: " << fit->scale << " +- " << fit->scale_sigma;
  }
}

TEST(MotionFitTest, WithoutMotionItSaysThatItCannotTell) {
  const Recorded recorded(1.5, 2, 0.01);
  const std::optional<MotionFit> fit = FitMotion(recorded.steps, recorded.imu, 9.81);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->scale_sigma, 0.5);
  EXPECT_FALSE(fit->Disagrees());
}

TEST(MotionFitTest, SinglePosesThatWentAstrayAreLeftOut) {
  Recorded recorded(1, 1);
  const std::vector<std::size_t> astray{5, 12, 20};
  for (const std::size_t k : astray) recorded.steps[k].T_map_body.p += Eigen::Vector3d(0.05, -0.03, 0.02);
  const std::optional<MotionFit> fit = FitMotion(recorded.steps, recorded.imu, 9.81);
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->Disagrees());
  EXPECT_LT(fit->misfit, 0.006);
  EXPECT_EQ(fit->fitting.size() + astray.size(), recorded.steps.size());
  for (const std::size_t k : astray)
    EXPECT_FALSE(std::binary_search(fit->fitting.begin(), fit->fitting.end(), k));
}

TEST(MotionFitTest, ButNotWhereManyPosesDisagree) {
  Recorded recorded(1, 1);
  for (std::size_t k = 0; k < recorded.steps.size(); k += 2) recorded.steps[k].T_map_body.p.x() += 0.1;
  const std::optional<MotionFit> fit = FitMotion(recorded.steps, recorded.imu, 9.81);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->misfit, 0.03);
  EXPECT_GE(4 * fit->fitting.size(), 3 * recorded.steps.size());
}

TEST(MotionFitTest, AFewPosesSayNothing) {
  const Recorded recorded(1, 0.2);
  EXPECT_FALSE(FitMotion(recorded.steps, recorded.imu, 9.81));
}

ScaleWatch::Verdict Watched(const Recorded& recorded) {
  ScaleWatch watch(9.81);
  std::size_t sample = 0;
  for (const FollowedPlace::Step& step : recorded.steps) {
    std::vector<ImuSample> imu;
    for (; sample < recorded.imu.size() && recorded.imu[sample].t <= step.t; ++sample)
      imu.push_back(recorded.imu[sample]);
    const ScaleWatch::Verdict verdict = watch.Add(step.t, step.T_map_body, imu);
    if (verdict != ScaleWatch::Verdict::kOpen) return verdict;
  }
  return ScaleWatch::Verdict::kOpen;
}

TEST(ScaleWatchTest, SaysWhetherTheMapsSizeIsRight) {
  EXPECT_EQ(Watched(Recorded(1.5, 5)), ScaleWatch::Verdict::kDisagrees);
  EXPECT_EQ(Watched(Recorded(0.67, 5)), ScaleWatch::Verdict::kDisagrees);
  EXPECT_EQ(Watched(Recorded(1, 11)), ScaleWatch::Verdict::kAgrees);
  EXPECT_EQ(Watched(Recorded(1, 0.5)), ScaleWatch::Verdict::kOpen);
}

}  // namespace
}  // namespace evit
