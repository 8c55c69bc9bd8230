#include "common/map/map_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/helpers/map_files.h"

namespace evit {
namespace {

using test::Load;
using test::LoadError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TextMapTest, SpacesTabsCommasCommentsAndMoreColumns) {
  const LoadedMap loaded = Load("# made by hand\n1 2 3\n\n4,5,6\r\n\t7\t8\t-9.5e-1 0.1 nan\n  # end\n");
  EXPECT_THAT(loaded.map.points,
              ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(4, 5, 6), Eigen::Vector3f(7, 8, -0.95F)));
  EXPECT_EQ(loaded.format, "text");
  EXPECT_EQ(Load("x, y, z\n1, 2, 3\n").map.points.size(), 1u);  // column names
}

TEST(TextMapTest, Broken) {
  EXPECT_THAT(LoadError("1 2 3\n4 5\n"), HasSubstr("line 2"));
  EXPECT_THAT(LoadError("# c\n1 2 3\n4 five 6\n"), HasSubstr("line 3"));
  EXPECT_THAT(LoadError("# nothing\n"), HasSubstr("the map is empty"));
  EXPECT_THAT(LoadError(""), HasSubstr("is empty"));
  EXPECT_THAT(LoadError("nan nan nan\n1 inf 2\n"), HasSubstr("none of its 2 points is finite"));
  EXPECT_THAT(LoadError(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)), HasSubstr("line 1"));
  EXPECT_THROW(LoadMap("/nowhere/map.pcd"), std::runtime_error);
  EXPECT_THROW(LoadMap(::testing::TempDir()), std::runtime_error);
}

TEST(TextMapTest, DropsAndCountsWhatIsNotFinite) {
  const LoadedMap loaded = Load("nan 1 2\n1 2 3\n1 1e99 2\n");
  EXPECT_EQ(loaded.map.points.size(), 1u);
  EXPECT_EQ(loaded.n_dropped, 2u);
}

TEST(WritePcdTest, ComesBackBitByBit) {
  PointMap map;
  std::mt19937 random(1);
  for (int k = 0; k < 1000; ++k) {
    map.points.emplace_back(
        Eigen::Vector3f::NullaryExpr([&] { return 1e-6F * static_cast<float>(random()); }));
  }
  const test::TemporaryFile file("", "written.pcd");
  WritePcd(file.path(), map);
  const LoadedMap loaded = LoadMap(file.path());
  EXPECT_EQ(loaded.map.points, map.points);
  EXPECT_EQ(loaded.format, "PCD binary");
}

TEST(WritePcdTest, FailureLeavesNothing) {
  const PointMap map{{{1, 2, 3}}};
  EXPECT_THROW(WritePcd("/nowhere/map.pcd", map), std::runtime_error);
  const std::string folder = ::testing::TempDir() + "map_file_test_" + std::to_string(::getpid());
  std::filesystem::create_directory(folder);
  EXPECT_THROW(WritePcd(folder, map), std::runtime_error);  // a folder is in the way
  EXPECT_FALSE(std::filesystem::exists(folder + ".part"));
  std::filesystem::remove(folder);
}

PointMap Grid(float spacing) {
  PointMap map;
  for (int k = 0; k < 4096; ++k) {
    map.points.push_back(spacing * Eigen::Vector3f(static_cast<float>(k % 16),
                                                   static_cast<float>((k / 16) % 16),
                                                   static_cast<float>(k >> 8)));
  }
  return map;
}

TEST(SummarizeTest, BoundsMedianAndSpacing) {
  PointMap map = Grid(0.01F);
  map.points.emplace_back(-100, 0, 50);  // one stray
  const MapSummary summary = Summarize(map);
  EXPECT_EQ(summary.n_points, 4097u);
  EXPECT_EQ(summary.min, Eigen::Vector3f(-100, 0, 0));
  EXPECT_FLOAT_EQ(summary.max.x(), 0.15F);
  EXPECT_FLOAT_EQ(summary.max.z(), 50);
  EXPECT_NEAR(summary.median.x(), 0.075, 0.01);
  EXPECT_NEAR(summary.median_spacing, 0.01, 1e-4);
  EXPECT_EQ(Summarize({{{1, 2, 3}}}).median_spacing, 0);
}

TEST(RequireMetresTest, TellsMillimetres) {
  EXPECT_NO_THROW(RequireMetres(Summarize(Grid(0.01F)), "map.pcd"));
  EXPECT_NO_THROW(RequireMetres(Summarize(Grid(0.2F)), "map.pcd"));
  try {
    RequireMetres(Summarize(Grid(10)), "map.pcd");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("map.pcd: "));
    EXPECT_THAT(error.what(), HasSubstr("millimetres"));
    EXPECT_THAT(error.what(), HasSubstr("--scale 0.001"));
  }
}

}  // namespace
}  // namespace evit
