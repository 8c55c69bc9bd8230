#include "common/localization/panorama.h"

#include <gtest/gtest.h>

#include <random>

#include "common/localization/edge_points.h"
#include "common/localization/prior_text.h"

namespace evit {
namespace {

TEST(Panorama, PlacesAreAzimuthAndElevation) {
  std::mt19937 rng(3);
  std::normal_distribution<float> u;
  for (int k = 0; k < 5000; ++k) {
    const float x = u(rng), y = u(rng), z = u(rng);
    const int place = panorama::PlaceOf(x, y, z);
    const double column = (std::atan2(y, x) + panorama::kPi) / panorama::kBin;
    const double row = (std::atan2(z, std::hypot(x, y)) + panorama::kPi / 2) / panorama::kBin;
    const double apart = std::remainder(place % panorama::kColumns + 0.5 - column, panorama::kColumns);
    EXPECT_LT(std::abs(apart), 0.501) << x << " " << y << " " << z;
    EXPECT_LT(std::abs(place / panorama::kColumns + 0.5 - row), 0.501);
  }
}

TEST(Panorama, DirectionsOfLevelAndUprightEdges) {
  const auto bin = [](float dx, float dy, float dz) {
    return panorama::DirectionBin(panorama::LineAt(2, 1, 0.3F, dx, dy, dz));
  };
  EXPECT_EQ(bin(-1, 2, 0), 0);
  EXPECT_EQ(bin(1, -2, 0), 0);  // a line has no sign
  EXPECT_EQ(bin(0, 0, 1), 2);
  EXPECT_EQ(bin(-1, 2, 2.2F), 1);
  EXPECT_EQ(bin(-1, 2, -2.2F), 3);
}

TEST(EdgePoints, LinesHaveTheirDirection) {
  PointMap map;
  for (int k = 0; k < 200; ++k) map.points.emplace_back(0.01F * static_cast<float>(k), 1.0F, 2.0F);
  for (int k = 0; k < 30; ++k)
    map.points.emplace_back(5.0F + static_cast<float>(k), 7.0F, 2.0F);  // far apart
  const std::vector<EdgePoint> edges = ThinEdges(map, {});
  int lines = 0;
  for (const EdgePoint& e : edges) {
    if (e.at.x() > 4) {
      EXPECT_TRUE(e.along.isZero());
      continue;
    }
    ++lines;
    EXPECT_GT(std::abs(e.along.x()), 0.999F);
  }
  EXPECT_NEAR(lines, 67, 3);  // one every 3 cm
}

TEST(EdgePoints, NoMoreThanAllowed) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(0, 3);
  PointMap map;
  for (int k = 0; k < 30'000; ++k) map.points.emplace_back(u(rng), u(rng), u(rng));
  EdgePointOptions options;
  options.max_points = 2000;
  const std::size_t n = ThinEdges(map, options).size();
  EXPECT_LE(n, 2000U);
  EXPECT_GT(n, 800U);
}

TEST(PlacePrior, IsReadAndHeldTo) {
  const PlacePrior prior = ParsePlacePrior("1 2 0.5 1.5", "0:2", "90:20");
  const auto pose = [](double x, double z, double yaw) {
    return SE3(ExpSO3({0, 0, yaw * panorama::kPi / 180}), {x, 2, z});
  };
  EXPECT_TRUE(prior.Allows(pose(1, 1, 80), 0, 0));
  EXPECT_FALSE(prior.Allows(pose(3, 1, 80), 0, 0));
  EXPECT_TRUE(prior.Allows(pose(2.6, 0.5, 80), 0.2, 0));
  EXPECT_FALSE(prior.Allows(pose(1, 1.9, 200), 0, 0));
  EXPECT_FALSE(prior.Allows(pose(1, -0.4, 80), 0, 0));
  EXPECT_TRUE(ParsePlacePrior("", "", "").open());
  EXPECT_THROW(ParsePlacePrior("1 2 3", "", ""), std::runtime_error);
  EXPECT_THROW(ParsePlacePrior("1 2 3 -1", "", ""), std::runtime_error);
  EXPECT_THROW(ParsePlacePrior("", "2:1", ""), std::runtime_error);
  EXPECT_THROW(ParsePlacePrior("", "", "north"), std::runtime_error);
}

}  // namespace
}  // namespace evit
