#include "common/tracking/bootstrapper.h"

#include <gtest/gtest.h>

#include "tests/helpers/tracking_bench.h"

namespace evit {
namespace {

using Status = Bootstrapper::Result::Status;

// High-rate frames, 10 ms apart, of a room that is in view as a whole.
class BootstrapperTest : public ::testing::Test {
 protected:
  BootstrapperTest() { points_.Add(source_.Ids(), source_.room, {}); }

  void StartAt(const SE3& T_map_body) {
    BodyState start;
    start.T_map_body = T_map_body;
    bootstrapper_.Start(start);
  }
  Bootstrapper::Result Step(const std::vector<Eigen::Vector3f>& seen_points) {
    const bool first = t_ == 1'000'000;
    const KeyframeInput keyframe = source_.Next(t_ += 10'000, seen_points);
    return bootstrapper_.Process(keyframe, !first,
                                 keyframe.imu.empty() ? Eigen::Vector3d::Zero() : keyframe.imu.back().gyro);
  }

  TrackerOptions options_ = TestOptions();
  KeyframeSource source_;
  PointSelector points_{TestRig(), source_.settings, options_.points, options_.lag_px};
  Bootstrapper bootstrapper_{TestRig(), options_, source_.settings, &points_};
  Utime t_ = 1'000'000;
};

TEST_F(BootstrapperTest, LocalisesFramesUntilVelocitiesAndBiasesAreKnown) {
  StartAt(source_.Truth(t_).Plus((Vector6d() << 0.02, -0.02, 0.01, 0.01, -0.01, 0.01).finished()));
  Bootstrapper::Result result = Step(source_.room);
  for (int k = 1; k < options_.bootstrap.min_frames; ++k) {
    EXPECT_EQ(result.status, Status::kUnsure);
    result = Step(source_.room);
  }
  EXPECT_EQ(result.status, Status::kLocalized);
  EXPECT_LT((bootstrapper_.state().T_map_body.p - source_.Truth(t_).p).norm(), 0.01);
  for (int k = 0; k < 100 && result.status != Status::kAligned; ++k) {
    EXPECT_TRUE(result.window.empty());
    result = Step(source_.room);
  }
  ASSERT_EQ(result.status, Status::kAligned) << result.reason;
  ASSERT_EQ(result.window.size(), static_cast<std::size_t>(options_.window.size));
  const WindowNode& newest = result.window.back();
  EXPECT_EQ(newest.t, t_);
  EXPECT_LT((newest.state.velocity - source_.motion.State(ToSeconds(t_)).velocity).norm(), 0.1);
  EXPECT_LT((newest.state.bias.gyro - source_.bias.gyro).norm(), 0.02);
  EXPECT_EQ(result.prior.mean.T_map_body.p, result.window.front().state.T_map_body.p);
}

TEST_F(BootstrapperTest, RejectsFramesOfAnotherRoomAndGivesUpHopeAfterAWhile) {
  StartAt(source_.Truth(t_));
  const auto other = synthetic::RoomPoints(60, 99);
  Bootstrapper::Result last;
  int rejected = 0;
  for (int k = 0; k < 250 && last.status != Status::kHopeless; ++k) {
    last = Step(other);
    if (last.status == Status::kRejected) {
      ++rejected;
      EXPECT_EQ(last.reason, "waiting for events that fit the map");
    }
    EXPECT_NE(last.status, Status::kAligned);
  }
  EXPECT_GE(rejected, 100);
  EXPECT_EQ(last.status, Status::kHopeless);
  EXPECT_NE(last.reason.find("does not lie on the events"), std::string::npos) << last.reason;
}

TEST_F(BootstrapperTest, ARejectedFrameBreaksTheChain) {
  StartAt(source_.Truth(t_));
  for (int k = 0; k < 3; ++k) Step(source_.room);
  EXPECT_EQ(Step(synthetic::RoomPoints(60, 99)).status, Status::kRejected);
  EXPECT_EQ(Step(source_.room).status, Status::kUnsure);
}

TEST_F(BootstrapperTest, AsksForMoreFramesWhereTheStartPoseWasFarOff) {
  SE3 wrong = source_.Truth(t_);
  wrong.p.x() += 0.16;
  StartAt(wrong);
  int frames = 0, found_after = 0;
  for (int rejected = 0; frames < 100 && found_after == 0; ++frames) {
    const Bootstrapper::Result result = Step(source_.room);
    if (result.status == Status::kRejected) ++rejected;
    if (result.status == Status::kLocalized) found_after = frames + 1 - rejected;
  }
  EXPECT_GE(found_after, 15);
  EXPECT_LE(found_after, 40);
  EXPECT_LT((bootstrapper_.state().T_map_body.p - source_.Truth(t_).p).norm(), 0.01);
}

TEST_F(BootstrapperTest, DoesNotWaitForMotion) {
  const SE3 T_map_body = source_.Truth(t_);
  StartAt(T_map_body);
  Bootstrapper::Result result;
  int frames = 0;
  for (; frames < 100 && result.status != Status::kAligned; ++frames) {
    // The same view again and again, from a body at rest.
    KeyframeInput keyframe = source_.Next(1'000'000, source_.room);
    keyframe.t = t_ += 10'000;
    keyframe.seq = frames;
    keyframe.imu.clear();
    for (Utime t = t_ - 10'000; frames > 0 && t <= t_; t += 5'000)
      keyframe.imu.push_back(
          {t, Eigen::Vector3d::Zero(), T_map_body.q.conjugate() * Eigen::Vector3d(0, 0, TestRig().gravity)});
    result = bootstrapper_.Process(keyframe, frames > 0, Eigen::Vector3d::Zero());
  }
  ASSERT_EQ(result.status, Status::kAligned) << result.reason;
  EXPECT_LE(frames, 20);
  EXPECT_LT(result.window.back().state.velocity.norm(), 0.1);
}

}  // namespace
}  // namespace evit
