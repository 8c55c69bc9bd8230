#include "tools/paper/run_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/helpers/paper.h"
#include "tools/paper/jerk.h"
#include "tools/run/report_writer.h"

namespace evit::paper {
namespace {

constexpr Utime kBegin = 1'642'661'138'000'000;

// Along x at 1 m/s in a wide screw, as a straight line leaves an alignment's turn open; a pose every 20 ms.
Trajectory Along(double seconds, const Eigen::Vector3d& offset, double drift = 0) {
  Trajectory poses;
  for (Utime t = 0; t <= static_cast<Utime>(1e6 * seconds); t += 20'000) {
    const double s = ToSeconds(t);
    poses.push_back({kBegin + t,
                     {Eigen::Quaterniond::Identity(),
                      Eigen::Vector3d(s, drift * s + 0.3 * std::sin(s), 1 + 0.3 * std::cos(s)) + offset}});
  }
  return poses;
}

TEST(Score, FirstPairAlignmentRemovesAConstantOffset) {
  const RunScore score = ScoreTrajectory(Along(10, {0, 0, 0}), Along(10, {0, 0.03, 0.04}), {});
  for (std::size_t m = 0; m < kMilestones.size(); ++m) {
    ASSERT_TRUE(score.ate[0][m] && score.ate[1][m] && score.ate[2][m]);
    EXPECT_NEAR(score.ate[0][m]->position_cm, 0, 1e-6);
    EXPECT_NEAR(score.ate[1][m]->position_cm, 0, 1e-6);
    EXPECT_NEAR(score.ate[2][m]->position_cm, 5, 1e-6);
  }
  EXPECT_NEAR(score.keyframe_rate_hz, 50, 1e-9);
  EXPECT_DOUBLE_EQ(score.tracked, 1);
}

TEST(Score, ErrorsCountUpToTheMilestoneOnly) {
  const RunScore score = ScoreTrajectory(Along(10, {0, 0, 0}), Along(10, {0, 0, 0}, 0.01), {});
  // RMSE of a drift that grows evenly: its end over the root of three.
  EXPECT_NEAR(score.ate[0][0]->position_cm, 3 / std::sqrt(3), 0.02);
  EXPECT_NEAR(score.ate[0][1]->position_cm, 5 / std::sqrt(3), 0.02);
  EXPECT_NEAR(score.ate[0][2]->position_cm, 10 / std::sqrt(3), 0.03);
}

TEST(Score, MilestoneIsNotReachedAfterEndOrLoss) {
  const Trajectory truth = Along(10, {0, 0, 0});
  const RunScore ended = ScoreTrajectory(truth, Along(4, {0, 0, 0}), {});
  EXPECT_TRUE(ended.ate[0][0]);
  EXPECT_FALSE(ended.ate[0][1]);
  EXPECT_FALSE(ended.ate[0][2]);
  // Lost after 6 s: that it found itself again and tracked to the end does not count.
  const RunScore lost = ScoreTrajectory(truth, Along(10, {0, 0, 0}), kBegin + 6'000'000);
  EXPECT_TRUE(lost.ate[0][1]);
  EXPECT_FALSE(lost.ate[0][2]);
  EXPECT_NEAR(lost.tracked, 0.6, 0.01);
  const RunScore never = ScoreTrajectory(truth, {}, {});
  EXPECT_FALSE(never.ate[0][0]);
  EXPECT_DOUBLE_EQ(never.keyframe_rate_hz, 0);
}

class ScoreRunTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteTum(folder_ / "truth.tum", Along(12, {0, 0, 0}));
    report_.set_begin_utime(static_cast<double>(kBegin));
    report_.set_end_utime(static_cast<double>(kBegin + 10'000'000));
    report_.set_sequence_s(10);
    report_.add_services()->set_cpu_s(2);
    report_.add_services()->set_cpu_s(3);
  }
  void Write(const Trajectory& poses) {
    report_.set_poses(static_cast<int>(poses.size()));
    WriteTum(folder_ / "trajectory.tum", poses);
    run::WriteReport(folder_ / "report.json", report_);
  }
  void AddMode(const char* mode, Utime t, const char* reason) {
    auto* change = report_.add_mode_changes();
    change->set_mode(mode);
    change->set_utime(static_cast<double>(kBegin + t));
    change->set_reason(reason);
  }
  TestFolder folder_{"paper_score"};
  report::Report report_;
};

TEST_F(ScoreRunTest, IsScoredOverThePartThatWasPlayed) {
  Write(Along(10, {0, 0, 0}));
  const RunScore score = ScoreRun(folder_.path(), folder_ / "truth.tum");
  EXPECT_TRUE(score.ate[0][2]) << "the truth continues for 2 s more";
  EXPECT_DOUBLE_EQ(score.cpu_s_per_s, 0.5);
  EXPECT_EQ(score.lost, "");
}

TEST_F(ScoreRunTest, EndsAtTheFirstLossAfterTracking) {
  AddMode("LOST", -100'000, "no map in view");
  AddMode("TRACKING", 0, "tracking");
  AddMode("LOST", 4'000'000, "no events");
  AddMode("TRACKING", 5'000'000, "found");
  Write(Along(10, {0, 0, 0}));
  const RunScore score = ScoreRun(folder_.path(), folder_ / "truth.tum");
  EXPECT_EQ(score.lost, "after 4.00 s: no events");
  EXPECT_TRUE(score.ate[0][0]);
  EXPECT_FALSE(score.ate[0][1]);
  EXPECT_EQ(TrackedPart(folder_.path()).back().t, kBegin + 3'980'000);
}

TEST_F(ScoreRunTest, WithoutPosesReachesNoMilestone) {
  Write({});
  const RunScore score = ScoreRun(folder_.path(), folder_ / "truth.tum");
  EXPECT_FALSE(score.ate[2][0]);
  EXPECT_EQ(score.lost, "no pose at all");
  EXPECT_TRUE(TrackedPart(folder_.path()).empty());
}

TEST_F(ScoreRunTest, MissingReportIsNamed) {
  EXPECT_THAT([&] { ScoreRun(folder_.path(), folder_ / "truth.tum"); },
              ::testing::ThrowsMessage<std::runtime_error>(::testing::HasSubstr("report.json")));
}

TEST(Jerk, IsWhereTheRotationChanges) {
  Trajectory poses;
  for (int k = 0; k <= 1000; ++k) {  // still, then turning from 4 s on
    const double angle = std::max(0.0, 0.01 * k - 4);
    poses.push_back({kBegin + Utime{10'000} * k, {ExpSO3(Eigen::Vector3d(0, 0, angle)), {0, 0, 0}}});
  }
  EXPECT_NEAR(ToSeconds(MostJerky(poses, 2, 1) - kBegin), 4, 0.05);
  EXPECT_GE(ToSeconds(MostJerky(poses, 5, 1) - kBegin), 5);
}

}  // namespace
}  // namespace evit::paper
