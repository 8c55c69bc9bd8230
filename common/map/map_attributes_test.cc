#include <gtest/gtest.h>

#include "common/map/map_file.h"
#include "tests/helpers/map_files.h"

namespace evit {
namespace {

PointMap Attributed() {
  PointMap map;
  for (int k = 0; k < 4; ++k) {
    const auto v = static_cast<float>(k);
    map.points.emplace_back(v, 2 * v, 0.5F);
    map.attributes.push_back({{0, 1, 0}, 0.001F * v, 10 + v, 0.25F * v});
  }
  return map;
}

TEST(MapAttributes, ComeBackFromPcdAndPly) {
  for (const char* name : {"map.pcd", "map.ply"}) {
    const test::TemporaryFile file("", name);
    WriteMap(file.path(), Attributed());
    const PointMap read = LoadMap(file.path()).map;
    ASSERT_EQ(read.points.size(), 4U) << name;
    ASSERT_EQ(read.attributes.size(), 4U) << name;
    for (std::size_t k = 0; k < 4; ++k) {
      const PointAttributes &a = read.attributes[k], b = Attributed().attributes[k];
      EXPECT_EQ(read.points[k], Attributed().points[k]);
      EXPECT_EQ(a.direction, b.direction);
      EXPECT_EQ(a.sigma, b.sigma);
      EXPECT_EQ(a.views, b.views);
      EXPECT_EQ(a.contrast, b.contrast);
    }
  }
}

TEST(MapAttributes, AreLeftOutWhereThereAreNone) {
  const test::TemporaryFile file("", "plain.pcd");
  PointMap map = Attributed();
  map.attributes.clear();
  WritePcd(file.path(), map);
  EXPECT_TRUE(LoadMap(file.path()).map.attributes.empty());
}

TEST(MapAttributes, StayWithTheirPointsWhereOthersAreDropped) {
  const test::TemporaryFile file("", "holes.pcd");
  PointMap map = Attributed();
  map.points[1].x() = std::numeric_limits<float>::quiet_NaN();
  WritePcd(file.path(), map);
  const LoadedMap read = LoadMap(file.path());
  EXPECT_EQ(read.n_dropped, 1U);
  ASSERT_EQ(read.map.attributes.size(), 3U);
  EXPECT_EQ(read.map.attributes[1].views, 12);
}

}  // namespace
}  // namespace evit
