#include "common/mapping/line_thinning.h"

#include <gtest/gtest.h>

#include <random>

namespace evit {
namespace {

MappedPoint PointAt(double x, double y, double z) {
  MappedPoint p;
  p.position = {x, y, z};
  p.direction = Eigen::Vector3d::UnitX();
  p.sigma = 0.004;
  return p;
}

// A line of 1 m along x, seen by many views that err by some millimetres.
std::vector<MappedPoint> NoisyLine() {
  std::mt19937 random(1);
  std::normal_distribution<double> off(0, 0.003);
  std::uniform_real_distribution<double> along(0, 1);
  std::vector<MappedPoint> points;
  for (int k = 0; k < 4000; ++k) points.push_back(PointAt(along(random), off(random), 1 + off(random)));
  return points;
}

TEST(ThinToLines, MakesOneLineOfABundle) {
  const auto line = ThinToLines(NoisyLine(), {}, 2);
  EXPECT_GT(line.size(), 200U);
  EXPECT_LT(line.size(), 900U);
  double square = 0;
  for (const MappedPoint& p : line)
    square += (p.position - Eigen::Vector3d(p.position.x(), 0, 1)).squaredNorm();
  EXPECT_LT(std::sqrt(square / static_cast<double>(line.size())), 0.003);
  const auto again = ThinToLines(NoisyLine(), {}, 1);
  ASSERT_EQ(again.size(), line.size());
  for (std::size_t k = 0; k < line.size(); ++k) EXPECT_EQ(again[k].position, line[k].position);
}

TEST(ThinToVoxels, KeepsTheMeanOfEachVoxelAndDirection) {
  std::vector<MappedPoint> points = {PointAt(0.001, 0.001, 1.001), PointAt(0.003, 0.003, 1.003),
                                     PointAt(0.009, 0.001, 1.001), PointAt(0.001, 0.001, 1.001)};
  points[1].sigma = 0.002;
  points[3].direction = Eigen::Vector3d::UnitY();
  const auto thin = ThinToVoxels(points, 0.004);
  ASSERT_EQ(thin.size(), 3U);
  EXPECT_NEAR(thin[0].position.x(), 0.0026, 1e-5);  // four times the weight
  EXPECT_NEAR(thin[0].sigma, 0.0018, 1e-4);
  EXPECT_EQ(thin[1].position, points[2].position);
  EXPECT_EQ(thin[2].direction, Eigen::Vector3d::UnitY());
}

TEST(ForDepth, LinesOfNearScenesAreFiner) {
  const LineThinningOptions far = ForDepth({}, 2), near = ForDepth({}, 0.65);
  EXPECT_DOUBLE_EQ(far.voxel_m, 0.004);
  EXPECT_DOUBLE_EQ(far.reach_m, 0.015);
  EXPECT_DOUBLE_EQ(near.voxel_m, 0.002);
  EXPECT_DOUBLE_EQ(near.reach_m, 0.0075);
  LineThinningOptions fixed;
  fixed.finer_near = false;
  EXPECT_DOUBLE_EQ(ForDepth(fixed, 0.65).voxel_m, 0.004);
}

// What was mismatched lies about, each point in a depth of its own; points of another direction do not help
// it.
TEST(DropLonePoints, KeepsLinesToTheirEndsAndDropsWhatLiesAbout) {
  std::vector<MappedPoint> points;
  for (int k = 0; k < 50; ++k) points.push_back(PointAt(0.004 * k, 0, 1));
  const std::size_t line = points.size();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(0, 0.2);
  for (int k = 0; k < 60; ++k)
    points.push_back(PointAt(anywhere(random), 0.05 + anywhere(random), 1.2 + anywhere(random)));
  for (int k = 0; k < 10; ++k) {
    points.push_back(PointAt(0.3 + 0.004 * k, 0, 1));
    points.back().direction = k % 2 == 0 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  }
  const auto kept = DropLonePoints(points, {}, 2);
  ASSERT_EQ(kept.size(), line);
  for (std::size_t k = 0; k < line; ++k) EXPECT_EQ(kept[k].position, points[k].position);
  LineThinningOptions coarse;  // one point on all of a line's part
  coarse.voxel_m = 0.1;
  EXPECT_EQ(DropLonePoints(points, coarse, 2).size(), points.size());
  EXPECT_TRUE(DropLonePoints({}, {}, 2).empty());
}

}  // namespace
}  // namespace evit
