// `evit map`, the program.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/helpers/map_files.h"
#include "tests/helpers/run_evit.h"

namespace evit::commands {
namespace {

using test::TemporaryFile;
using ::testing::HasSubstr;

using Result = test::ProgramOutcome;

Result Map(const std::string& arguments) { return test::RunEvit("map " + arguments); }

// A grid of 10 x 10 x 10 points, `spacing` apart, with a hole.
std::string Cloud(double spacing) {
  std::string text = "nan nan nan\n";
  for (int k = 0; k < 1000; ++k) {
    text += std::to_string(spacing * (k % 10)) + " " + std::to_string(spacing * (k % 100 - k % 10) / 10) +
            " " + std::to_string(spacing * (k - k % 100) / 100) + " 1 2 3\n";
  }
  return text;
}

TEST(MapCommandTest, MillimetresNeedScale) {
  const TemporaryFile in(Cloud(20), "mm.txt"), out("", "out.pcd");
  std::filesystem::remove(out.path());
  Result result = Map("import " + in.path() + " " + out.path());
  EXPECT_EQ(result.code, 1);
  EXPECT_FALSE(std::filesystem::exists(out.path()));
  // The remedy can be typed as it stands.
  const std::string remedy = "import " + in.path() + " --scale 0.001 --out ";
  EXPECT_THAT(result.output, HasSubstr("`evit map " + remedy));
  EXPECT_EQ(Map(remedy + out.path()).code, 0);
  EXPECT_NEAR(LoadMap(out.path()).map.points.back().z(), 0.18, 1e-5);
  EXPECT_EQ(Map("info " + in.path()).code, 1);

  result = Map("import " + in.path() + " " + out.path() +
               " --scale 0.001 --transform '0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1'");
  EXPECT_EQ(result.code, 0) << result.output;
  const LoadedMap loaded = LoadMap(out.path());
  ASSERT_EQ(loaded.map.points.size(), 1000u);
  EXPECT_EQ(loaded.format, "PCD binary");
  EXPECT_LT((loaded.map.points[1] - Eigen::Vector3f(5, 6.02F, 7)).norm(), 1e-5);
  EXPECT_LT((loaded.map.points[10] - Eigen::Vector3f(4.98F, 6, 7)).norm(), 1e-5);
}

TEST(MapCommandTest, VoxelsThinTheCloud) {
  const TemporaryFile in(Cloud(0.02), "dense.txt"), out("", "thin.pcd");
  const Result result = Map("import " + in.path() + " " + out.path() + " --voxel 0.1");
  EXPECT_EQ(result.code, 0) << result.output;
  EXPECT_EQ(LoadMap(out.path()).map.points.size(), 8u);
}

TEST(MapCommandTest, InfoPrintsTextAndJson) {
  const TemporaryFile in(Cloud(0.02), "info.txt");
  Result result = Map("info " + in.path());
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr("1000 (1 not finite"));
  result = Map("info --json " + in.path());
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["points"], 1000);
  EXPECT_NEAR(json["spacing_m"].get<double>(), 0.02, 1e-4);
  EXPECT_NEAR(json["max_m"][2].get<double>(), 0.18, 1e-4);
}

TEST(MapCommandTest, TopViewIsDrawn) {
  const TemporaryFile in(Cloud(0.02), "view.txt"), out("", "view.png");
  std::filesystem::remove(out.path());
  EXPECT_EQ(Map("info " + in.path() + " --png " + out.path()).code, 0);
  const cv::Mat picture = cv::imread(out.path());
  ASSERT_FALSE(picture.empty());
  EXPECT_GT(picture.cols, 400);
  cv::Mat ink;
  cv::inRange(picture, cv::Scalar(255, 255, 255), cv::Scalar(255, 255, 255), ink);
  EXPECT_LT(cv::countNonZero(ink), picture.rows * picture.cols - 100);

  const Result result = Map("info " + in.path() + " --png /nowhere/view.png");
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.output, HasSubstr("/nowhere/view.png"));
}

TEST(MapCommandTest, BadInputFailsNamingTheOption) {
  const TemporaryFile empty("", "empty.pcd"), in(Cloud(0.02), "in.txt");
  EXPECT_EQ(Map("info " + empty.path()).code, 1);
  EXPECT_EQ(Map("info /nowhere/map.pcd").code, 1);
  EXPECT_EQ(Map("import " + in.path() + " /nowhere/out.pcd").code, 1);
  EXPECT_NE(Map("import " + in.path() + " " + empty.path() + " --scale 0").code, 0);
  const Result result = Map("import " + in.path() + " " + empty.path() + " --transform '1 2 3'");
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.output, HasSubstr("--transform"));
}

TEST(MapCommandTest, PhotometricOutputIsCheckedBeforeFusing) {
  Result result = Map("photometric /nowhere --out /tmp/map.pcd");
  EXPECT_NE(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr(".ply"));
  result = Map("photometric /nowhere --out /not/there/map.ply");
  EXPECT_NE(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr("there is no folder /not/there"));
  result = Map("photometric /nowhere --out /tmp/map.ply");
  EXPECT_NE(result.code, 0);
  EXPECT_THAT(result.output, HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace evit::commands
