#include "services/window_optimizer/result_publisher.h"

#include "tests/helpers/optimizer_peer.h"

namespace evit {
namespace {

class ResultPublisherTest : public test::OptimizerPeer {
 protected:
  void SetUp() override { Listen(); }
  static ProcessedKeyframe Processed(std::int64_t seq, bool has_pose) {
    ProcessedKeyframe processed;
    processed.keyframe.message.utime = 1000 * (seq + 1);
    processed.keyframe.message.seq = seq;
    processed.keyframe.message.epoch = 77;
    processed.keyframe.message.lookahead_us = 500;
    processed.keyframe.arrived = std::chrono::steady_clock::now();
    processed.output.mode = TrackerMode::kTracking;
    processed.output.reason = "all is well";
    processed.output.has_pose = has_pose;
    processed.output.covariance.setIdentity();
    if (has_pose) processed.output.nodes.push_back({1000 * (seq + 1), seq, {}});
    processed.solve_ms = 2;
    return processed;
  }

  StatusReporter status_{service_bus_.get(), channels_, "window_optimizer", 9};
  ResultPublisher publisher_{service_bus_.get(), channels_, &status_};
};

TEST_F(ResultPublisherTest, AWindowCarriesWhatItCost) {
  publisher_.PublishWindow(Processed(3, true));
  bus_->Poll(0);
  ASSERT_EQ(windows_.size(), 1U);
  EXPECT_EQ(windows_[0].epoch, 9);
  EXPECT_EQ(windows_[0].keyframe_seq, 3);
  EXPECT_EQ(windows_[0].lookahead_us, 500);
  EXPECT_EQ(windows_[0].solve_ms, 2);
  EXPECT_GE(windows_[0].total_ms, 0);
}

TEST_F(ResultPublisherTest, WithoutAPoseThereIsNoWindow) {
  publisher_.PublishWindow(Processed(3, false));
  bus_->Poll(0);
  EXPECT_TRUE(windows_.empty());
}

TEST_F(ResultPublisherTest, AModeAnswersItsKeyframe) {
  EXPECT_FALSE(publisher_.has_answered());
  publisher_.PublishMode(Processed(3, true), 2);
  EXPECT_TRUE(publisher_.has_answered());
  bus_->Poll(0);
  ASSERT_EQ(modes_.size(), 1U);
  EXPECT_EQ(modes_[0].keyframe_seq, 3);
  EXPECT_EQ(modes_[0].keyframe_epoch, 77);
  EXPECT_EQ(modes_[0].mode, tracker_mode_t::TRACKING);
  EXPECT_EQ(modes_[0].keyframe_stride, 2);
  EXPECT_EQ(status_.state(), "running");
  EXPECT_EQ(status_.Counter("mode.tracking"), 1);
}

TEST_F(ResultPublisherTest, TheNewestModeIsSaidAgainUnderANewNumber) {
  publisher_.PublishModeAgain();  // nothing yet
  publisher_.PublishMode(Processed(3, true), 1);
  publisher_.PublishMode(Processed(4, true), 1);
  publisher_.PublishModeAgain();
  bus_->Poll(0);
  ASSERT_EQ(modes_.size(), 3U);
  EXPECT_EQ(modes_[2].keyframe_seq, 4);
  EXPECT_EQ(modes_[2].seq, 2);
}

TEST_F(ResultPublisherTest, AnAnnouncementIsNoAnswer) {
  tracker_mode_t announcement{};
  announcement.keyframe_seq = 8;
  announcement.keyframe_stride = 1;
  announcement.resend = 1;
  publisher_.PublishAnnouncement(announcement);
  EXPECT_FALSE(publisher_.has_answered());
  bus_->Poll(0);
  ASSERT_EQ(modes_.size(), 1U);
  EXPECT_EQ(modes_[0].epoch, 9);
  EXPECT_EQ(modes_[0].resend, 1);
}

TEST_F(ResultPublisherTest, PosesAreNumbered) {
  for (int k = 0; k < 2; ++k)
    publisher_.PublishPose(100 + k, {SE3(Eigen::Quaterniond::Identity(), {1.0 * k, 0, 0}), {0, 0, 2}});
  bus_->Poll(0);
  ASSERT_EQ(poses_.size(), 2U);
  EXPECT_EQ(poses_[1].seq, 1);
  EXPECT_EQ(poses_[1].utime, 101);
  EXPECT_EQ(poses_[1].position[0], 1);
  EXPECT_EQ(poses_[1].velocity[2], 2);
}

}  // namespace
}  // namespace evit
