#include "common/map/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evit {
namespace {

// Three long edges, each point of them misplaced by `noise` m per axis, far from the origin.
PointMap NoisyEdges(double noise, double spacing, std::vector<Eigen::Vector3f>* truth) {
  std::mt19937 random(3);
  std::normal_distribution<float> gauss(0, static_cast<float>(noise));
  PointMap map;
  for (int axis = 0; axis < 3; ++axis) {
    for (double s = 0; s < 1; s += spacing) {
      Eigen::Vector3f p(40, -20, 5);
      p[axis] += static_cast<float>(s);
      p[(axis + 1) % 3] += 3.0F * static_cast<float>(axis + 1);
      truth->push_back(p);
      map.points.push_back(p + Eigen::Vector3f(gauss(random), gauss(random), gauss(random)));
    }
  }
  return map;
}

// RMS distance across the edges (along them a point may go where it likes).
double ErrorAcross(const PointMap& map, const std::vector<Eigen::Vector3f>& truth) {
  double sum = 0;
  const std::size_t per_edge = truth.size() / 3;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    Eigen::Vector3f d = map.points[i] - truth[i];
    d[static_cast<int>(i / per_edge)] = 0;
    sum += d.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(map.points.size()));
}

TEST(Denoise, MovesPointsOntoTheEdgesTheyComeFrom) {
  std::vector<Eigen::Vector3f> truth;
  PointMap map = NoisyEdges(0.003, 0.001, &truth);
  const double before = ErrorAcross(map, truth);
  const DenoiseSummary summary = Denoise({}, &map);
  ASSERT_EQ(map.points.size(), truth.size());
  EXPECT_EQ(summary.n_moved, truth.size());
  EXPECT_LT(ErrorAcross(map, truth), 0.4 * before);
}

TEST(Denoise, LeavesCleanEdgesWhereTheyAre) {
  std::vector<Eigen::Vector3f> truth;
  PointMap map = NoisyEdges(0, 0.002, &truth);
  Denoise({}, &map);
  EXPECT_LT(ErrorAcross(map, truth), 1e-5);
}

TEST(Denoise, DropsLonelyPointsOfADenseMapOnly) {
  std::vector<Eigen::Vector3f> truth;
  PointMap dense = NoisyEdges(0.001, 0.001, &truth);
  dense.points.emplace_back(0, 0, 0);
  EXPECT_EQ(Denoise({}, &dense).n_dropped, 1U);
  EXPECT_EQ(dense.points.size(), truth.size());

  truth.clear();
  PointMap sparse = NoisyEdges(0.001, 0.02, &truth);
  const std::vector<Eigen::Vector3f> before = sparse.points;
  const DenoiseSummary summary = Denoise({}, &sparse);
  EXPECT_EQ(summary.n_dropped, 0U);
  EXPECT_EQ(sparse.points.size(), before.size());
}

TEST(Denoise, LeavesAMapThatKnowsItsSigmasAsItIs) {
  std::vector<Eigen::Vector3f> truth;
  PointMap map = NoisyEdges(0.003, 0.001, &truth);
  EXPECT_GT(DenoiseSettingsFor(map).radius, 0);
  map.attributes.resize(map.points.size());
  const std::vector<Eigen::Vector3f> before = map.points;
  EXPECT_EQ(Denoise(DenoiseSettingsFor(map), &map).n_moved, 0U);
  EXPECT_EQ(map.points, before);
}

TEST(Denoise, CrowdsAndFarPointsDoNotHoldItUp) {
  std::mt19937 random(5);
  std::normal_distribution<float> gauss(0, 0.001F);
  PointMap map;
  for (int i = 0; i < 100'000; ++i) map.points.emplace_back(gauss(random), gauss(random), gauss(random));
  map.points.emplace_back(1e30F, -1e30F, 1e9F);
  const DenoiseSummary summary = Denoise({}, &map);  // minutes where each point asks each other
  EXPECT_EQ(summary.n_dropped, 1U);
  EXPECT_EQ(map.points.size(), 100'000U);
}

TEST(Denoise, StraysThatShareACellDoNotSpoilEachOther) {
  PointMap map;
  for (int k = 0; k < 8; ++k) map.points.emplace_back(1e30F, 0, 0);
  map.points.emplace_back(3e38F, 0, 0);
  const std::vector<Eigen::Vector3f> before = map.points;
  EXPECT_EQ(Denoise({}, &map).n_moved, 8U);
  EXPECT_EQ(map.points, before);
}

TEST(Denoise, EmptyMapsAndNoRadiusAreFine) {
  PointMap map;
  EXPECT_EQ(Denoise({}, &map).n_moved, 0U);
  map.points.emplace_back(1, 2, 3);
  DenoiseSettings off;
  off.radius = 0;
  EXPECT_EQ(Denoise(off, &map).n_moved, 0U);
  EXPECT_EQ(map.points.size(), 1U);
}

}  // namespace
}  // namespace evit
