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

TEST(TextMapTest, WhatOtherProgramsWrite) {
  const auto two = ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(4, 5, 6));
  for (const char* text : {
           "2\n1 2 3 -1204 7 7 7\n4 5 6 -1100 8 8 8\n",                        // PTS
           "//X,Y,Z,R,G,B\n1,2,3,9,9,9\n4,5,6,9,9,9\n",                        // CloudCompare
           "\xEF\xBB\xBF\"x\";\"y\";\"z\"\r\n\"1\";\"2\";\"3\"\r\n4;5;6\r\n",  // spreadsheets
           "1.000000000000000000e+00 2.0e0 3e0\n4 5 6.0\n",                    // numpy.savetxt
           "id,x,y,z\n7,1,2,3\n8,4,5,6\n",
           "# x y z\r1 2 3\r4 5 6\r",
           "1 2 3 # left\n4 5 6 // right\n",
       }) {
    EXPECT_THAT(Load(text).map.points, two) << text;
  }
  EXPECT_THAT(LoadError("0,31 0,29 0,23\n"), HasSubstr("decimal commas"));
}

// Seven digits before the point: a float keeps half a metre of them.
TEST(LoadMapTest, SurveyCoordinatesKeepTheirMillimetresWhenMoved) {
  const SE3 T(Eigen::Quaterniond::Identity(), {-492818, -5527515, 0});
  const std::string text = "492818.3115 5527515.2967 0.2386\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n" +
      text;
  const std::string pcd =
      "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ";
  const std::string ascii = std::string(pcd).append("ascii\n").append(text);
  const std::string binary = std::string(pcd)
                                 .append("binary\n")
                                 .append(test::Raw(492818.3115))
                                 .append(test::Raw(5527515.2967))
                                 .append(test::Raw(0.2386));
  for (const std::string& bytes : {text, ply, ascii, binary}) {
    const test::TemporaryFile file(bytes, "survey");
    const LoadedMap loaded = LoadMap(file.path(), {1, T});
    ASSERT_EQ(loaded.map.points.size(), 1u);
    EXPECT_LT((loaded.map.points[0] - Eigen::Vector3f(0.3115F, 0.2967F, 0.2386F)).norm(), 1e-6) << bytes;
    // Not moved they are of no use, which is said with the remedy.
    try {
      RequireMetres(Summarize(LoadMap(file.path()).map), "survey.ply");
      ADD_FAILURE();
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("--transform \"1 0 0 -492818"));
    }
  }
}

TEST(TextMapTest, ABrokenFileIsRefusedByItsFault) {
  EXPECT_THAT(LoadError("1 2 3\n4 5\n"), HasSubstr("line:2"));
  EXPECT_THAT(LoadError("# c\n1 2 3\n4 five 6\n"), HasSubstr("line:3"));
  EXPECT_THAT(LoadError("# nothing\n"), HasSubstr("the map is empty"));
  EXPECT_THAT(LoadError(""), HasSubstr("is empty"));
  EXPECT_THAT(LoadError("nan nan nan\n1 inf 2\n"), HasSubstr("none of its 2 points is finite"));
  EXPECT_THAT(LoadError(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)),
              HasSubstr("neither a PCD nor a PLY nor text"));
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
    EXPECT_THAT(error.what(), HasSubstr("`evit map import map.pcd --scale 0.001 --out map_metres.pcd`"));
  }
}

}  // namespace
}  // namespace evit
