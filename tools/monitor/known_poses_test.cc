#include "tools/monitor/known_poses.h"

#include <gtest/gtest.h>

#include "common/wire/geometry_wire.h"

namespace evit::monitor {
namespace {

void Add(Utime t, double x, int mode, KnownPoses* poses) {
  window_state_t window{};
  window.mode = static_cast<std::int8_t>(mode);
  window.node.resize(1);
  window.node[0].utime = window.utime = t;
  PutPose(SE3(Eigen::Quaterniond::Identity(), {x, 0, 0}), &window.node[0]);
  poses->OnWindow(window, -1);
}

TEST(KnownPosesTest, TheNearestOfTheNewestPassCounts) {
  KnownPoses poses;
  EXPECT_FALSE(poses.At(1'000'000));
  for (int k = 0; k < 100; ++k) Add(1'000'000 + 20'000 * k, k, tracker_mode_t::TRACKING, &poses);
  ASSERT_TRUE(poses.At(1'980'000));
  EXPECT_NEAR(poses.At(1'980'000)->p.x(), 49, 2.6);
  EXPECT_NEAR(poses.At(800'000)->p.x(), 0, 5);
  EXPECT_FALSE(poses.At(600'000));
  EXPECT_FALSE(poses.At(3'400'000));
  Add(1'990'000, -7, tracker_mode_t::TRACKING, &poses);
  EXPECT_EQ(poses.At(1'990'000)->p.x(), -7);
}

TEST(KnownPosesTest, APoseOfATrackerThatIsNotTrackingIsNone) {
  KnownPoses poses;
  Add(1'000'000, 1, tracker_mode_t::BOOTSTRAPPING, &poses);
  Add(1'000'000, 1, tracker_mode_t::LOST, &poses);
  poses.OnWindow(window_state_t{}, -1);
  EXPECT_FALSE(poses.At(1'000'000));
}

TEST(KnownPosesTest, MemoryHasALimit) {
  KnownPoses poses;
  for (std::size_t k = 0; k < KnownPoses::kMost + 5; ++k) {
    Add(static_cast<Utime>(k) * 100'000, 1, tracker_mode_t::TRACKING, &poses);
  }
  EXPECT_TRUE(poses.At((KnownPoses::kMost - 1) * 100'000));
  EXPECT_FALSE(poses.At((KnownPoses::kMost + 4) * 100'000));
}

}  // namespace
}  // namespace evit::monitor
