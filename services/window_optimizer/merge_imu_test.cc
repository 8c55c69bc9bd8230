#include "services/window_optimizer/merge_imu.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

keyframe_t Keyframe(std::int64_t previous, std::int64_t utime) {
  keyframe_t k{};
  k.epoch = 7;
  k.previous_utime = previous;
  k.utime = utime;
  k.n_events = 1000;
  for (std::int64_t t = previous; t <= utime; t += 5000) {
    k.imu_utime.push_back(t);
    k.gyro.push_back({static_cast<double>(t), 0, 0});
    k.accel.push_back({0, static_cast<double>(t), 0});
  }
  k.n_imu = static_cast<std::int32_t>(k.imu_utime.size());
  k.imu_gap_us = 5000;
  return k;
}

TEST(MergeImu, ADroppedKeyframeLeavesItsImuSamplesToTheNext) {
  const keyframe_t before = Keyframe(100'000, 120'000);
  keyframe_t after = Keyframe(120'000, 140'000);
  MergeImu(before, &after);
  const keyframe_t whole = Keyframe(100'000, 140'000);
  EXPECT_EQ(after.previous_utime, 100'000);
  EXPECT_EQ(after.n_imu, whole.n_imu);
  EXPECT_EQ(after.imu_utime, whole.imu_utime);
  EXPECT_EQ(after.gyro, whole.gyro);
  EXPECT_EQ(after.accel, whole.accel);
  EXPECT_EQ(after.n_events, 2000);
}

TEST(MergeImu, OnlyNeighboursAreJoined) {
  const keyframe_t before = Keyframe(100'000, 120'000);
  keyframe_t apart = Keyframe(125'000, 140'000), other_epoch = Keyframe(120'000, 140'000);
  other_epoch.epoch = 8;
  for (keyframe_t* after : {&apart, &other_epoch}) {
    const keyframe_t as_it_was = *after;
    MergeImu(before, after);
    EXPECT_EQ(after->imu_utime, as_it_was.imu_utime);
    EXPECT_EQ(after->previous_utime, as_it_was.previous_utime);
  }
}

TEST(MergeImu, TheNumberOfSamplesHasABound) {
  keyframe_t all = Keyframe(0, 20'000);
  for (std::int64_t t = 20'000; t < 60'000'000; t += 20'000) {
    keyframe_t next = Keyframe(t, t + 20'000);
    MergeImu(all, &next);
    all = std::move(next);
    ASSERT_LE(all.n_imu, 4000);
  }
}

}  // namespace
}  // namespace evit
