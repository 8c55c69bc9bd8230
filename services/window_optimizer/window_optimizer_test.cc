// The service alone: recorded-like keyframes, map answers and IMU in, window states, modes and poses out. The
// real bus is in tests/.
#include "tests/helpers/window_optimizer_fixture.h"

namespace evit::test {
namespace {

TEST_F(WindowOptimizerTest, TracksAndAnswersEveryKeyframe) {
  Start(true);
  UntilTracking();
  for (int k = 0; k < 40; ++k) {
    Send(channels_.keyframe, Keyframe(last_ + 25'000));
    Pump();
  }
  ASSERT_EQ(modes_.size(), static_cast<std::size_t>(keyframe_seq_));
  for (std::size_t k = 0; k < modes_.size(); ++k)
    EXPECT_EQ(modes_[k].keyframe_seq, static_cast<std::int64_t>(k));
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_GT(modes_.back().image_speed, 0);
  ASSERT_FALSE(windows_.empty());
  const node_state_t& newest = windows_.back().node.back();
  EXPECT_EQ(newest.utime, last_);
  const SE3 truth = motion_.State(ToSeconds(last_)).T_map_body;
  EXPECT_LT((Eigen::Vector3d(newest.position) - truth.p).norm(), 0.006);
  EXPECT_LT(queries_, keyframe_seq_);  // the view moves a few pixels at a time
  EXPECT_EQ(queries_ + Counter("MAP_QUERY.spared"), keyframe_seq_ + 1);
  ASSERT_GT(poses_.size(), 100U);  // IMU rate: five per keyframe of 25 ms
  for (std::size_t k = 1; k < poses_.size(); ++k) EXPECT_GT(poses_[k].utime, poses_[k - 1].utime);
}

TEST_F(WindowOptimizerTest, LosslessWaitsForTheMapServer) {
  map_server_up_ = false;
  Start(true);
  for (int k = 0; k < 5; ++k) {
    Send(channels_.keyframe, Keyframe(1'000'000 + k * 10'000));
    Pump();
  }
  EXPECT_TRUE(modes_.empty());
  map_server_up_ = true;  // comes up late: the query is sent again and everything continues
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (modes_.size() < 5 && std::chrono::steady_clock::now() < give_up) Pump();
  EXPECT_EQ(modes_.size(), 5U);
}

TEST_F(WindowOptimizerTest, KeyframesOutOfOrderWaitAndDuplicatesAreAnsweredAgain) {
  Start(true);
  const keyframe_t first = Keyframe(1'000'000), second = Keyframe(1'010'000);
  Send(channels_.keyframe, second);
  Pump();
  EXPECT_TRUE(modes_.empty());
  Send(channels_.keyframe, first);
  Send(channels_.keyframe, second);
  Pump();
  ASSERT_EQ(modes_.size(), 2U);
  Send(channels_.keyframe, second);
  Pump();
  ASSERT_EQ(modes_.size(), 3U);
  EXPECT_EQ(modes_.back().keyframe_seq, 1);
}

TEST_F(WindowOptimizerTest, LostKeyframeIsBridgedFromItsOwnImu) {
  Start(false);
  const Utime begin = UntilTracking();
  SendImu(begin - 50'000, begin + 1'000'000);
  for (int k = 0; k < 20; ++k) {
    const keyframe_t message = Keyframe(last_ + 25'000);
    if (k % 5 == 2) continue;  // lost on the way
    Send(channels_.keyframe, message);
    Pump();
  }
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_EQ(Counter("KEYFRAME.bridged"), 4);
  EXPECT_EQ(Counter("KEYFRAME.lost"), 4);
}

TEST_F(WindowOptimizerTest, OverloadTakesPointsThenKeyframesAndGivesThemBack) {
  Start(false);
  const Utime begin = UntilTracking();
  SendImu(begin - 50'000, begin + 20'000'000);
  Send(channels_.keyframe, Keyframe(last_ + 25'000));
  Pump();
  const int points = windows_.back().n_points;
  EXPECT_EQ(modes_.back().keyframe_stride, 1);
  bool fewer_points_before_sparser = false;
  for (int burst = 0; burst < 25; ++burst) {
    for (int k = 0; k < 8; ++k) Send(channels_.keyframe, Keyframe(last_ + 10'000));
    service_bus_->Poll(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // they wait
    for (int k = 0; k < 4; ++k) Pump();
    fewer_points_before_sparser |= windows_.back().n_points < points && modes_.back().keyframe_stride == 1;
  }
  EXPECT_TRUE(fewer_points_before_sparser);
  EXPECT_GT(modes_.back().keyframe_stride, 1);
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_GT(Counter("KEYFRAME.dropped"), 0);
  EXPECT_GT(Counter("overload.level"), 2);
  for (int round = 0; round < 3 && (round == 0 || Counter("overload.level") > 0);
       ++round) {  // a slow host needs more
    for (int k = 0; k < 450; ++k) {
      Send(channels_.keyframe, Keyframe(last_ + 10'000));
      Pump();
    }
  }
  EXPECT_EQ(Counter("overload.level"), 0);
  EXPECT_EQ(modes_.back().keyframe_stride, 1);
  EXPECT_NEAR(windows_.back().n_points, points, 0.3 * points);
}

TEST_F(WindowOptimizerTest, BadMessagesAreCountedAndSurvived) {
  Start(false);
  std::vector<std::uint8_t> garbage(300, 0xab);
  for (const std::string& channel : {channels_.keyframe, channels_.map_points, channels_.imu}) {
    bus_->Publish(channel, garbage.data(), garbage.size());
  }
  keyframe_t nan = Keyframe(1'000'000);
  nan.accel[0][1] = std::nan("");
  Send(channels_.keyframe, nan);
  keyframe_t small = Keyframe(1'010'000);
  small.width = small.height = 16;
  small.surface_size = 256;
  small.surface.assign(256, 255);
  Send(channels_.keyframe, small);
  Pump();
  EXPECT_TRUE(modes_.empty());
  EXPECT_EQ(Counter("KEYFRAME.invalid"), 3);
  EXPECT_EQ(Counter("MAP_POINTS.invalid"), 1);
  EXPECT_EQ(Counter("IMU.invalid"), 1);
  EXPECT_TRUE(std::any_of(statuses_.begin(), statuses_.end(), [](const service_status_t& s) {
    return s.state == "failed" && s.detail.find("--rig") != std::string::npos;
  }));
  keyframe_seq_ = 2;
  UntilTracking();
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING);
}

}  // namespace
}  // namespace evit::test
