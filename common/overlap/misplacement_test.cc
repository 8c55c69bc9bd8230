#include "common/overlap/misplacement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

// Lines of points on a wall 2 m ahead of a camera that moves sideways and turns, and events where it sees
// them.
struct Bench {
  Bench() {
    rig.camera.width = 320, rig.camera.height = 240;
    rig.camera.fx = rig.camera.fy = 250;
    rig.camera.cx = 160, rig.camera.cy = 120;
    for (int line = -4; line <= 4; ++line) {
      for (double s = -0.8; s < 0.8; s += 0.005) {
        map.emplace_back(0.17F * static_cast<float>(line), static_cast<float>(s), 2.0F);
        map.emplace_back(static_cast<float>(s), 0.15F * static_cast<float>(line) + 0.02F, 2.2F);
      }
    }
    for (int k = 0; k <= 200; ++k) {
      const double t = 0.01 * k;
      body.push_back({k * 10'000,
                      {ExpSO3({0.1 * std::sin(3 * t), 0.15 * std::cos(2 * t), 0.1 * std::sin(2 * t)}),
                       {0.2 * std::sin(2 * t), 0.15 * std::cos(3 * t), 0.1 * std::sin(t)}}});
    }
  }

  // The views as the trajectory says, with the events that `real` sees at `late` us after.
  std::vector<MapView> Views(const Rig& real, Utime late, const Eigen::Vector3d& shift) const {
    std::vector<MapView> views;
    for (Utime t = 200'000; t < 1'800'000; t += 100'000) {
      MapView view;
      view.utime = t;
      PoseAt(body, t, &view.T_map_body);
      view.points = map;
      view.fired = PixelSet(real.camera.width, real.camera.height);
      SE3 T;
      PoseAt(body, t - late, &T);
      T.p += shift;
      const SE3 T_camera_map = (T * real.T_body_camera).Inverse();
      for (const Eigen::Vector3f& p : map) {
        Eigen::Vector2d pixel;
        if (!real.camera.Project(T_camera_map * p.cast<double>(), &pixel)) continue;
        view.fired.Add(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
      }
      views.push_back(view);
    }
    return views;
  }

  // The best of the kinds.
  Misplacement Best(const std::vector<MapView>& views) const {
    const auto found = FindMisplacements(rig, body, views);
    return *std::max_element(found.begin(), found.end(),
                             [](const auto& a, const auto& b) { return a.point_share < b.point_share; });
  }

  Rig rig;
  Trajectory body;
  std::vector<Eigen::Vector3f> map;
};

TEST(FindMisplacements, FindsNothingBetterWhereAllIsRight) {
  const Bench bench;
  const auto views = bench.Views(bench.rig, 0, Eigen::Vector3d::Zero());
  EXPECT_GT(PointShare(bench.rig, bench.body, views), 0.99);
  for (const Misplacement& m : FindMisplacements(bench.rig, bench.body, views))
    EXPECT_LT(m.value.norm(), m.kind == Misplacement::Kind::kCentre ? 0.5 : 0.005)
        << static_cast<int>(m.kind);
}

TEST(FindMisplacements, FindsLateEvents) {
  const Bench bench;
  const Misplacement best = bench.Best(bench.Views(bench.rig, 40'000, Eigen::Vector3d::Zero()));
  EXPECT_EQ(best.kind, Misplacement::Kind::kTime);
  EXPECT_NEAR(best.value.x(), -0.04, 0.003);
  EXPECT_GT(best.point_share, 0.95);
}

TEST(FindMisplacements, FindsATurnedCamera) {
  const Bench bench;
  Rig real = bench.rig;
  const Eigen::Vector3d turn(0.01, -0.025, 0.02);
  real.T_body_camera.q = real.T_body_camera.q * ExpSO3(turn);
  const Misplacement best = bench.Best(bench.Views(real, 0, Eigen::Vector3d::Zero()));
  EXPECT_EQ(best.kind, Misplacement::Kind::kRotation);
  EXPECT_LT((best.value - turn).norm(), 0.003);
}

TEST(FindMisplacements, FindsAShiftedFrame) {
  const Bench bench;
  const Eigen::Vector3d shift(0.03, -0.02, 0.05);
  const Misplacement best = bench.Best(bench.Views(bench.rig, 0, shift));
  EXPECT_EQ(best.kind, Misplacement::Kind::kShift);
  EXPECT_LT((best.value - shift).norm(), 0.01);
}

TEST(FindMisplacements, FindsAWrongFocalLength) {
  const Bench bench;
  Rig real = bench.rig;
  real.camera.fx *= 1.05, real.camera.fy *= 1.05;
  const Misplacement best = bench.Best(bench.Views(real, 0, Eigen::Vector3d::Zero()));
  EXPECT_EQ(best.kind, Misplacement::Kind::kFocal);
  EXPECT_NEAR(best.value.x(), 0.05, 0.005);
}

TEST(FindMisplacements, FindsAWrongPrincipalPoint) {
  const Bench bench;
  Rig real = bench.rig;
  real.camera.cx += 8;
  // Before a flat wall a shift looks much the same, so it need not be the best. (Lines are 20 pixels apart.)
  const auto found = FindMisplacements(bench.rig, bench.body, bench.Views(real, 0, Eigen::Vector3d::Zero()));
  ASSERT_EQ(found.back().kind, Misplacement::Kind::kCentre);
  EXPECT_LT((found.back().value - Eigen::Vector3d(8, 0, 0)).norm(), 1);
  EXPECT_GT(found.back().point_share, 0.95);
}

TEST(FindMisplacements, BelievesNothingThatTakesTheMapOutOfView) {
  const Bench bench;
  std::vector<MapView> views = bench.Views(bench.rig, 0, Eigen::Vector3d::Zero());
  for (MapView& view : views) view.points.resize(5);
  for (const Misplacement& m : FindMisplacements(bench.rig, bench.body, views)) EXPECT_EQ(m.point_share, 0);
}

}  // namespace
}  // namespace evit
