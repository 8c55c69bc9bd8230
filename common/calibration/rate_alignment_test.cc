#include "common/calibration/rate_alignment.h"

#include <gtest/gtest.h>

#include "tests/helpers/calibration_recording.h"

namespace evit {
namespace {

TEST(RateAlignment, FindsRotationBiasAndOffset) {
  test::Recording recording;
  for (const Utime offset : {-62'300, 0, 8'400}) {
    recording.rig.camera_time_offset = offset;
    const RateAlignment found = AlignRates(recording.Camera(), ImuTrack(recording.Imu()));
    EXPECT_GT(found.n, 500);
    EXPECT_LT(AngularDistance(found.q_body_camera, recording.rig.T_body_camera.q), 0.01);
    EXPECT_LT((found.gyro_bias - recording.bias.gyro).norm(), 0.01);
    EXPECT_NEAR(static_cast<double>(found.offset), static_cast<double>(offset), 1'000);
    EXPECT_LT(found.rms, 0.1);
    EXPECT_GT(found.spread[1], 0.5);
    EXPECT_LT(found.spread[2], found.spread[1]);
  }
}

TEST(RateAlignment, SpreadTellsAboutHowManyAxesTheBodyTurned) {
  test::Recording recording;
  recording.motion = test::YawOnly;
  recording.pose_noise = 0.1;
  const RateAlignment found = AlignRates(recording.Camera(), ImuTrack(recording.Imu()));
  EXPECT_GT(found.spread[0], 1);
  EXPECT_LT(found.spread[1], 0.05);
  EXPECT_NEAR(static_cast<double>(found.offset), 3'000, 500);
}

TEST(RateAlignment, TooShortARecordingGivesNothing) {
  test::Recording recording;
  recording.seconds = 0.3;
  EXPECT_EQ(AlignRates(recording.Camera(), ImuTrack(recording.Imu())).n, 0);
  EXPECT_EQ(AlignRates({}, ImuTrack(recording.Imu())).n, 0);
}

TEST(ImuTrack, CutsAndTurns) {
  const ImuTrack track(test::HandheldImu(0, 2'000'000, 5'000));
  const std::vector<ImuSample> part = track.Between(101'000, 112'000);
  ASSERT_EQ(part.size(), 4U);  // 101, 105, 110, 112 ms
  EXPECT_EQ(part.front().t, 101'000);
  EXPECT_EQ(part[1].t, 105'000);
  EXPECT_EQ(part.back().t, 112'000);
  EXPECT_EQ(track.Between(100'000, 105'000).size(), 2U);
  EXPECT_EQ(track.Between(0, 2'000'000).size(), 401U);
  const Eigen::Quaterniond turn = track.Turn(303'000).conjugate() * track.Turn(1'702'000);
  const Eigen::Quaterniond truth =
      test::Handheld(303'000).T_map_body.q.conjugate() * test::Handheld(1'702'000).T_map_body.q;
  EXPECT_LT(AngularDistance(turn, truth), 1e-3);
}

TEST(ImuTrack, LongestPartWithoutHoles) {
  std::vector<ImuSample> samples;
  for (const Utime t : {0, 5, 10, 100, 105, 110, 115, 113, 118}) samples.emplace_back().t = 1'000 * t;
  const std::vector<ImuSample> whole = LongestWhole(samples, 50'000);
  ASSERT_EQ(whole.size(), 4U);
  EXPECT_EQ(whole.front().t, 100'000);
  EXPECT_TRUE(LongestWhole({}, 50'000).empty());
  EXPECT_TRUE(LongestWhole({samples[0], samples[3]}, 50'000).empty());
}

}  // namespace
}  // namespace evit
