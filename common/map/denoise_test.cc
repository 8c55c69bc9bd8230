#include "common/map/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/map/map_file.h"

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

constexpr DenoiseSettings kSettings{0.02};  // m

TEST(Denoise, MovesPointsOntoTheEdgesTheyComeFrom) {
  std::vector<Eigen::Vector3f> truth;
  PointMap map = NoisyEdges(0.003, 0.001, &truth);
  const double before = ErrorAcross(map, truth);
  EXPECT_EQ(Denoise(kSettings, &map).n_moved, truth.size());
  ASSERT_EQ(map.points.size(), truth.size());
  EXPECT_LT(ErrorAcross(map, truth), 0.4 * before);
}

TEST(Denoise, LeavesCleanEdgesWhereTheyAre) {
  std::vector<Eigen::Vector3f> truth;
  PointMap map = NoisyEdges(0, 0.002, &truth);
  Denoise(kSettings, &map);
  EXPECT_LT(ErrorAcross(map, truth), 1e-5);
}

TEST(Denoise, DropsStraysOfADenseMapOnly) {
  std::vector<Eigen::Vector3f> truth;
  PointMap dense = NoisyEdges(0.001, 0.001, &truth);
  dense.points.emplace_back(0, 0, 0);
  EXPECT_EQ(Denoise(kSettings, &dense).n_dropped, 1U);
  EXPECT_EQ(dense.points.size(), truth.size());

  truth.clear();
  PointMap sparse = NoisyEdges(0.001, 0.03, &truth);
  EXPECT_EQ(Denoise(kSettings, &sparse).n_dropped, 0U);
  EXPECT_EQ(sparse.points.size(), truth.size());
}

// Two edges 2 cm apart, each point less than that from the next: as of a book's spine.
TEST(Denoise, ARadiusThatFollowsTheSpacingDoesNotMergeNeighbouringEdges) {
  std::mt19937 random(7);
  std::normal_distribution<float> gauss(0, 0.001F);
  PointMap map;
  for (int k = 0; k < 500; ++k) {
    for (const float y : {0.F, 0.02F})
      map.points.emplace_back(0.005F * static_cast<float>(k), y + gauss(random), gauss(random));
  }
  const double spacing = Summarize(map).median_spacing;
  ASSERT_NEAR(spacing, 0.005, 0.001);
  const auto drawn_together = [&map](double radius) {
    PointMap moved = map;
    Denoise({radius}, &moved);
    double sum = 0;
    for (std::size_t k = 0; k < moved.points.size(); k += 2)
      sum += 0.02 - (moved.points[k + 1].y() - moved.points[k].y());
    return sum / (0.5 * static_cast<double>(moved.points.size()));
  };
  EXPECT_LT(std::abs(drawn_together(DenoiseSettingsFor(map, spacing).radius)), 2e-4);
  EXPECT_GT(drawn_together(0.03), 1e-3);
}

TEST(Denoise, RadiusFollowsTheSpacingWithinBounds) {
  std::vector<Eigen::Vector3f> truth;
  PointMap map = NoisyEdges(0.003, 0.001, &truth);
  EXPECT_DOUBLE_EQ(DenoiseSettingsFor(map, 0.006).radius, 0.015);
  EXPECT_DOUBLE_EQ(DenoiseSettingsFor(map, 0).radius, 0.01);
  EXPECT_DOUBLE_EQ(DenoiseSettingsFor(map, 0.3).radius, 0.025);
  map.attributes.resize(map.points.size());  // it knows its sigmas
  EXPECT_EQ(DenoiseSettingsFor(map, 0.006).radius, 0);
}

TEST(Denoise, CrowdsAndFarPointsDoNotHoldItUp) {
  std::mt19937 random(5);
  std::normal_distribution<float> gauss(0, 0.001F);
  PointMap map;
  for (int i = 0; i < 100'000; ++i) map.points.emplace_back(gauss(random), gauss(random), gauss(random));
  map.points.emplace_back(1e30F, -1e30F, 1e9F);
  // Minutes where each point asks each other.
  EXPECT_EQ(Denoise(kSettings, &map).n_dropped, 1U);
  EXPECT_EQ(map.points.size(), 100'000U);
}

TEST(Denoise, StraysThatShareACellDoNotSpoilEachOther) {
  PointMap map;
  for (int k = 0; k < 8; ++k) map.points.emplace_back(1e30F, 0, 0);
  map.points.emplace_back(3e38F, 0, 0);
  const std::vector<Eigen::Vector3f> eight(map.points.begin(), map.points.end() - 1);
  EXPECT_EQ(Denoise(kSettings, &map).n_moved, 8U);
  EXPECT_EQ(map.points, eight);
}

TEST(Denoise, EmptyMapsAndNoRadiusAreFine) {
  PointMap map;
  EXPECT_EQ(Denoise(kSettings, &map).n_moved, 0U);
  std::vector<Eigen::Vector3f> truth;
  map = NoisyEdges(0.003, 0.001, &truth);
  const std::vector<Eigen::Vector3f> before = map.points;
  EXPECT_EQ(Denoise({}, &map).n_moved, 0U);
  EXPECT_EQ(map.points, before);
}

}  // namespace
}  // namespace evit
