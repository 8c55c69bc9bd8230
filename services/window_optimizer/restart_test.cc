// The service after a restart: what it had is told by its checkpoint, what came since is sent again.
#include "tests/helpers/window_optimizer_fixture.h"

namespace evit::test {
namespace {

TEST_F(WindowOptimizerTest, RestartedItContinuesWithoutMissingAKeyframe) {
  WithCheckpoint();
  Start(false);
  TrackForAWhile();
  const std::int64_t last = modes_.back().keyframe_seq;
  service_.reset();
  std::vector<keyframe_t> missed;
  for (int k = 0; k < 6; ++k) missed.push_back(Keyframe(last_ + 25'000));  // nobody hears them
  modes_.clear();
  windows_.clear();
  StartAgain();
  ASSERT_FALSE(modes_.empty());  // it says where it was
  EXPECT_EQ(modes_[0].keyframe_seq, last);
  EXPECT_EQ(modes_[0].keyframe_epoch, 77);
  EXPECT_EQ(modes_[0].mode, tracker_mode_t::TRACKING);
  modes_.clear();
  Send(channels_.keyframe, Keyframe(last_ + 25'000));  // live, before those that are sent again
  Pump();
  EXPECT_TRUE(windows_.empty());
  for (const keyframe_t& keyframe : missed) Send(channels_.keyframe, keyframe);
  Pump();
  ASSERT_EQ(windows_.size(), 7U);
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    EXPECT_EQ(windows_[k].keyframe_seq, last + 1 + static_cast<std::int64_t>(k));
    EXPECT_EQ(windows_[k].mode, tracker_mode_t::TRACKING);
    const node_state_t& newest = windows_[k].node.back();
    const SE3 truth = motion_.State(ToSeconds(newest.utime)).T_map_body;
    EXPECT_LT((Eigen::Vector3d(newest.position) - truth.p).norm(), 0.006);
  }
  EXPECT_EQ(Counter("checkpoint.resumed"), 1);
  EXPECT_EQ(Counter("overload.level"), 0);
}

TEST_F(WindowOptimizerTest, RestartedWithoutThoseKeyframesItLooksWhereTheBodyMustBe) {
  WithCheckpoint();
  Start(false);
  TrackForAWhile();
  service_.reset();
  keyframe_seq_ = 0;  // frame_builder was restarted too: another epoch
  StartAgain();
  modes_.clear();
  for (int k = 0; k < 40 && (modes_.empty() || modes_.back().mode != tracker_mode_t::TRACKING); ++k) {
    keyframe_t keyframe = Keyframe(last_ + 10'000);
    keyframe.epoch = 78;
    keyframe.high_rate = 1;
    Send(channels_.keyframe, keyframe);
    Pump();
  }
  ASSERT_FALSE(modes_.empty());
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_EQ(Counter("checkpoint.used"), 1);
}

TEST_F(WindowOptimizerTest, RestartedWhileBootstrappingItContinuesToo) {
  WithCheckpoint();
  settings_.tracker.bootstrap.min_displacement_m = 0.1;
  settings_.tracker.bootstrap.min_rotation_deg = 20;
  Start(false);
  for (int k = 0; k < 12; ++k) {  // localises them, but does not track yet
    Send(channels_.keyframe, Keyframe(1'000'000 + k * 10'000));
    Pump();
  }
  ASSERT_FALSE(windows_.empty());
  ASSERT_EQ(modes_.back().mode, tracker_mode_t::BOOTSTRAPPING);
  const std::int64_t last = modes_.back().keyframe_seq;
  service_.reset();
  std::vector<keyframe_t> missed;
  for (int k = 0; k < 60; ++k) {  // the body moves far from where it began
    keyframe_t keyframe = Keyframe(last_ + 10'000);
    keyframe.high_rate = 1;
    missed.push_back(std::move(keyframe));
  }
  modes_.clear();
  StartAgain();
  ASSERT_FALSE(modes_.empty());
  EXPECT_EQ(modes_[0].keyframe_seq, last);
  EXPECT_EQ(modes_[0].mode, tracker_mode_t::BOOTSTRAPPING);
  for (int k = 0; k < 60 && modes_.back().mode != tracker_mode_t::TRACKING; ++k) {
    Send(channels_.keyframe, missed[k]);
    Pump();
  }
  ASSERT_EQ(modes_.back().mode, tracker_mode_t::TRACKING);
  EXPECT_EQ(modes_.back().keyframe_epoch, 77);
  const node_state_t& newest = windows_.back().node.back();
  const SE3 truth = motion_.State(ToSeconds(newest.utime)).T_map_body;
  EXPECT_LT((Eigen::Vector3d(newest.position) - truth.p).norm(), 0.01);
  EXPECT_EQ(Counter("checkpoint.resumed"), 1);
}

}  // namespace
}  // namespace evit::test
