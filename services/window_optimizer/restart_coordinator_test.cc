#include "services/window_optimizer/restart_coordinator.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

namespace evit {
namespace {

using std::chrono::milliseconds;
using Progress = KeyframeCatchUp::Progress;

constexpr Utime kThen = 5'000'000;

class RestartCoordinatorTest : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(file_.c_str()); }
  // What a run that died at keyframe 10 has left.
  void LeaveCheckpoint(bool tracking = true) {
    Checkpoint checkpoint;
    checkpoint.t = kThen;
    checkpoint.keyframe_epoch = 3;
    checkpoint.keyframe_seq = 10;
    checkpoint.state.velocity = {1, 0, 0};
    checkpoint.image_speed = 50;
    if (tracking) checkpoint.information.setIdentity();
    RestartCoordinator(file_).Store(checkpoint);
  }
  static keyframe_t Keyframe(std::int64_t seq, std::int64_t epoch = 3) {
    keyframe_t keyframe{};
    keyframe.seq = seq;
    keyframe.epoch = epoch;
    return keyframe;
  }

  std::string file_ = ::testing::TempDir() + "evit_restart_" + std::to_string(::getpid());
  RestartCoordinator::Clock::time_point now_ = RestartCoordinator::Clock::now();
};

TEST_F(RestartCoordinatorTest, WithoutAFileNothingIsKept) {
  const RestartCoordinator restart("");
  EXPECT_FALSE(restart.enabled());
  EXPECT_FALSE(restart.collecting());
  EXPECT_FALSE(restart.checkpoint().has_value());
}

TEST_F(RestartCoordinatorTest, TheFirstRunHasNothingToContinue) {
  const RestartCoordinator restart(file_);
  EXPECT_TRUE(restart.enabled());
  EXPECT_FALSE(restart.collecting());
  EXPECT_FALSE(restart.checkpoint().has_value());
}

TEST_F(RestartCoordinatorTest, AnnouncesTheLastKeyframeAsItsAnswerDid) {
  LeaveCheckpoint();
  RestartCoordinator restart(file_);
  const tracker_mode_t said = restart.Announce(now_);
  EXPECT_EQ(said.keyframe_seq, 10);
  EXPECT_EQ(said.keyframe_epoch, 3);
  EXPECT_EQ(said.utime, kThen);
  EXPECT_EQ(said.mode, tracker_mode_t::TRACKING);
  EXPECT_EQ(said.image_speed, 50);
  EXPECT_EQ(said.resend, 1);
}

TEST_F(RestartCoordinatorTest, AnnouncesThatItWasBootstrapping) {
  LeaveCheckpoint(false);
  EXPECT_EQ(RestartCoordinator(file_).Announce(now_).mode, tracker_mode_t::BOOTSTRAPPING);
}

TEST_F(RestartCoordinatorTest, AnnouncesAgainNowAndThen) {
  LeaveCheckpoint();
  RestartCoordinator restart(file_);
  EXPECT_TRUE(restart.AnnouncementDue(now_));
  restart.Announce(now_);
  EXPECT_FALSE(restart.AnnouncementDue(now_ + milliseconds(50)));
  EXPECT_TRUE(restart.AnnouncementDue(now_ + milliseconds(51)));
}

TEST_F(RestartCoordinatorTest, CollectsTheKeyframesSinceTheCheckpoint) {
  LeaveCheckpoint();
  RestartCoordinator restart(file_);
  ASSERT_TRUE(restart.collecting());
  restart.Collect(Keyframe(12), now_);
  EXPECT_EQ(restart.ProgressAt(now_), Progress::kWaiting);
  restart.Collect(Keyframe(11), now_);
  EXPECT_EQ(restart.ProgressAt(now_), Progress::kWhole);
  const std::vector<keyframe_t> keyframes = restart.TakeKeyframes();
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_EQ(keyframes[0].seq, 11);
  EXPECT_FALSE(restart.collecting());
  EXPECT_TRUE(restart.checkpoint().has_value());
  restart.Done();
  EXPECT_FALSE(restart.checkpoint().has_value());
}

TEST_F(RestartCoordinatorTest, AnotherFrameBuilderHasNoneOfThem) {
  LeaveCheckpoint();
  RestartCoordinator restart(file_);
  restart.Collect(Keyframe(0, 4), now_);
  EXPECT_EQ(restart.ProgressAt(now_), Progress::kHopeless);
}

TEST_F(RestartCoordinatorTest, PredictsWhereTheBodyIsSoonAfter) {
  LeaveCheckpoint();
  const RestartCoordinator restart(file_);
  const auto state = restart.PredictedAt(kThen + 500'000);
  ASSERT_TRUE(state.has_value());
  EXPECT_NEAR(state->T_map_body.p.x(), 0.5, 1e-12);
}

TEST_F(RestartCoordinatorTest, PredictsNothingBeforeTheCheckpointOrLongAfter) {
  LeaveCheckpoint();
  const RestartCoordinator restart(file_);
  EXPECT_FALSE(restart.PredictedAt(kThen - 1).has_value());
  EXPECT_TRUE(restart.PredictedAt(kThen + 3'000'000).has_value());
  EXPECT_FALSE(restart.PredictedAt(kThen + 3'000'001).has_value());
}

TEST_F(RestartCoordinatorTest, AHintEndsTheRestart) {
  LeaveCheckpoint();
  RestartCoordinator restart(file_);
  restart.Done();
  EXPECT_FALSE(restart.collecting());
  EXPECT_FALSE(restart.checkpoint().has_value());
}

}  // namespace
}  // namespace evit
