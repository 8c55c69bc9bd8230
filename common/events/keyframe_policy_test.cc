#include "common/events/keyframe_policy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/helpers/event_streams.h"

namespace evit {
namespace {

using Mode = TrackerFeedback::Mode;

class KeyframePolicyTest : public ::testing::Test {
 protected:
  static KeyframePolicy::Situation At(Mode mode, Utime imu, std::int64_t n_events, int n_imu) {
    return {mode, 1, 0, 1'000'000, imu, imu - 5'000, n_events, n_imu};
  }
  // 1500 events, 4 samples, 60 ms with 200 events; high rate: 7.3 ms.
  KeyframePolicy policy_{test::SmallOptions().keyframes, test::SmallOptions().surface};
};

TEST_F(KeyframePolicyTest, TrackingNeedsEnoughEventsAndEnoughSamples) {
  EXPECT_FALSE(policy_.Due(At(Mode::kTracking, 1'020'000, 1'499, 4)));
  EXPECT_FALSE(policy_.Due(At(Mode::kTracking, 1'015'000, 90'000, 3)));
  EXPECT_EQ(policy_.Due(At(Mode::kTracking, 1'020'000, 1'500, 4)), 1'020'000);
}

TEST_F(KeyframePolicyTest, InOverloadTheyTakeMoreOfBoth) {
  auto s = At(Mode::kTracking, 1'040'000, 2'999, 8);
  s.stride = 2;
  EXPECT_FALSE(policy_.Due(s));
  s.n_events = 3'000;
  EXPECT_EQ(policy_.Due(s), 1'040'000);
  s.n_imu = 7;
  EXPECT_FALSE(policy_.Due(s));
}

TEST_F(KeyframePolicyTest, WaitsAsLongAsTheTrackerFindsMoreOfThemOfLittleUse) {
  auto s = At(Mode::kTracking, 1'025'000, 90'000, 5);
  s.useful_interval = 30'000;
  EXPECT_FALSE(policy_.Due(s));  // nearer to 25 ms than to 30 by less than half a sample
  s.imu += 2'500, s.imu_before += 2'500;
  EXPECT_EQ(policy_.Due(s), s.imu);
  s.stride = 2;  // overload counts besides
  s.n_imu = 20;
  EXPECT_FALSE(policy_.Due(s));
  s.imu = 1'057'500, s.imu_before = 1'052'500;
  EXPECT_EQ(policy_.Due(s), s.imu);
}

TEST_F(KeyframePolicyTest, TheTrackersWishHasALimit) {
  auto s = At(Mode::kTracking, 1'025'000, 90'000, 5);
  s.useful_interval = 1'000'000;
  EXPECT_FALSE(policy_.Due(s));
  s.imu = 1'030'000, s.imu_before = 1'025'000;
  EXPECT_EQ(policy_.Due(s), 1'030'000);
  KeyframeOptions keyframes = test::SmallOptions().keyframes;
  keyframes.relaxed_interval_ms = 0;
  s.imu = 1'020'000, s.imu_before = 1'015'000;
  EXPECT_EQ(KeyframePolicy(keyframes, test::SmallOptions().surface).Due(s), 1'020'000);
}

TEST_F(KeyframePolicyTest, SlowMotionMakesAKeyframeInTheEndAndStandstillTwiceAsLate) {
  EXPECT_FALSE(policy_.Due(At(Mode::kTracking, 1'059'999, 1'000, 12)));
  EXPECT_EQ(policy_.Due(At(Mode::kTracking, 1'060'000, 1'000, 12)), 1'060'000);
  EXPECT_FALSE(policy_.Due(At(Mode::kTracking, 1'119'999, 199, 24)));
  EXPECT_EQ(policy_.Due(At(Mode::kTracking, 1'120'000, 0, 24)), 1'120'000);
}

TEST_F(KeyframePolicyTest, HighRateStampsLieBetweenSamples) {
  for (const Mode mode : {Mode::kBootstrapping, Mode::kLost}) {
    EXPECT_FALSE(policy_.Due(At(mode, 1'007'299, 0, 1)));
    EXPECT_EQ(policy_.Due(At(mode, 1'007'300, 0, 1)), 1'007'300);
    EXPECT_EQ(policy_.Due(At(mode, 1'010'000, 0, 2)), 1'007'300);
  }
}

TEST_F(KeyframePolicyTest, AFixedRateKeepsToItself) {
  KeyframeOptions keyframes = test::SmallOptions().keyframes;
  keyframes.fixed_rate_hz = 100;
  const KeyframePolicy fixed(keyframes, test::SmallOptions().surface);
  for (const Mode mode : {Mode::kBootstrapping, Mode::kTracking, Mode::kLost}) {
    EXPECT_FALSE(fixed.Due(At(mode, 1'009'999, 1'000'000, 2)));
    EXPECT_EQ(fixed.Due(At(mode, 1'012'000, 0, 2)), 1'010'000);
  }
}

TEST_F(KeyframePolicyTest, NothingIsInterpolatedInsideAHoleOfTheImu) {
  EXPECT_EQ(policy_.Due({Mode::kLost, 1, 0, 1'000'000, 1'500'000, 1'005'000, 0, 2}), 1'500'000);
}

TEST_F(KeyframePolicyTest, DecayFollowsTheImageSpeed) {
  EXPECT_DOUBLE_EQ(policy_.DecayUs(0, 0), 8'000);        // unknown
  EXPECT_DOUBLE_EQ(policy_.DecayUs(1e-9, 0), 30'000);    // longest
  EXPECT_DOUBLE_EQ(policy_.DecayUs(300, 0), 10'000);     // 3 px
  EXPECT_DOUBLE_EQ(policy_.DecayUs(100'000, 0), 2'000);  // shortest
}

TEST_F(KeyframePolicyTest, FewEventsLastLonger) {
  // A surface shows the events of a keyframe, 1500, over both sides of its stamp.
  SurfaceOptions surface = test::SmallOptions().surface;
  surface.kind = SurfaceOptions::Kind::kSymmetric;
  surface.truncation = 255 / std::exp(1);  // to where an event has decayed by e
  const KeyframePolicy policy(test::SmallOptions().keyframes, surface);
  EXPECT_NEAR(policy.DecayUs(300, 0.05), 15'000, 1);
  EXPECT_DOUBLE_EQ(policy.DecayUs(300, 1), 10'000);      // more than enough along the tail
  EXPECT_DOUBLE_EQ(policy.DecayUs(300, 0.001), 30'000);  // longest
  EXPECT_NEAR(policy.DecayUs(0, 0.05), 15'000, 1);       // speed unknown
  surface.kind = SurfaceOptions::Kind::kCausal;
  EXPECT_NEAR(KeyframePolicy(test::SmallOptions().keyframes, surface).DecayUs(300, 0.1), 15'000, 1);
}

}  // namespace
}  // namespace evit
