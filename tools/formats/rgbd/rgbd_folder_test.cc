#include "tools/formats/rgbd/rgbd_folder.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "tests/helpers/paths.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RgbdFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"/images", "/depth"}) fs::create_directories(path_ + folder);
    for (int k = 0; k < 3; ++k) {
      const cv::Mat image(24, 32, CV_8UC3, cv::Scalar(10 * k, 10 * k, 10 * k)),
          depth(24, 32, CV_16UC1, cv::Scalar(1500 + k));
      cv::imwrite(path_ + "/images/" + std::to_string(k) + ".png", image);
      cv::imwrite(path_ + "/depth/" + std::to_string(k) + ".png", depth);
    }
    Write("poses.txt",
          "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1\n"
          "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    Write("K.txt", "30 0 15.5\n0 31 11.5\n0 0 1\n");
  }
  void TearDown() override { fs::remove_all(path_); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ + "/" + name) << text;
  }
  std::string Error() const {
    try {
      const RgbdFolder folder(path_);
      for (std::size_t k = 0; k < folder.size(); ++k) folder.Load(k);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  const std::string path_ = ::testing::TempDir() + "rgbd_" + std::to_string(::getpid());
};

TEST_F(RgbdFolderTest, ReadsImageDepthPoseAndCamera) {
  const RgbdFolder folder(path_);
  ASSERT_EQ(folder.size(), 3u);
  const RgbdView view = folder.Load(1);
  EXPECT_EQ(view.camera.width, 32);
  EXPECT_EQ(view.camera.height, 24);
  EXPECT_EQ(view.camera.fy, 31);
  EXPECT_EQ(view.camera.cx, 15.5);
  EXPECT_EQ(view.T_map_camera.p, Eigen::Vector3d(5, 6, 7));
  EXPECT_LT((view.T_map_camera * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(5, 7, 7)).norm(), 1e-9);
  ASSERT_EQ(view.depth.size(), 32u * 24u);
  EXPECT_NEAR(view.depth[100], 1.501, 1e-6);
  EXPECT_NEAR(view.intensity[100], 10.0 / 255, 1e-6);
}

// 10.png is the last of eleven, whose pose is the last row: as text it would come behind 1.png.
TEST_F(RgbdFolderTest, UnpaddedNumbersAreInTheirNaturalOrder) {
  std::string poses;
  for (int k = 0; k < 12; ++k) {
    const std::string name = std::to_string(k) + ".png";
    cv::imwrite(path_ + "/images/" + name, cv::Mat(24, 32, CV_8UC1, cv::Scalar(20 * k)));
    cv::imwrite(path_ + "/depth/" + name, cv::Mat(24, 32, CV_16UC1, cv::Scalar(1500)));
    poses += "1 0 0 " + std::to_string(k) + " 0 1 0 0 0 0 1 0 0 0 0 1\n";
  }
  Write("poses.txt", poses);
  const RgbdFolder folder(path_);
  ASSERT_EQ(folder.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    const RgbdView view = folder.Load(k);
    EXPECT_EQ(view.T_map_camera.p.x(), static_cast<double>(k));
    EXPECT_NEAR(view.intensity[0], 20.0 * static_cast<double>(k) / 255, 1e-6);
  }
}

TEST_F(RgbdFolderTest, ErrorsNameFileAndProblem) {
  EXPECT_EQ(Error(), "");
  Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_THAT(Error(), HasSubstr("has 1 poses, but there are 3 images"));
  Write("poses.txt", "1 0 0 0\n");
  EXPECT_THAT(Error(), HasSubstr("poses.txt:1: the line ends too early; expected \"16 numbers\""));
  Write("poses.txt", "2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_THAT(Error(), HasSubstr("pose 0: no camera-to-map transform"));
  SetUp();
  Write("K.txt", "30 0 15.5\n0 x 11.5\n0 0 1\n");
  EXPECT_THAT(Error(), HasSubstr("K.txt:2: \"x\" is not a number"));
  Write("K.txt", "30 0 15.5\n");
  EXPECT_THAT(Error(), HasSubstr("three rows"));
  SetUp();
  cv::imwrite(path_ + "/depth/2.png", cv::Mat(24, 32, CV_8UC1, cv::Scalar(9)));
  EXPECT_THAT(Error(), HasSubstr("2.png: expected 16-bit depth"));
  cv::imwrite(path_ + "/depth/2.png", cv::Mat(12, 32, CV_16UC1, cv::Scalar(9)));
  EXPECT_THAT(Error(), HasSubstr("is not of the size of"));
  fs::remove(path_ + "/depth/2.png");
  EXPECT_THAT(Error(), HasSubstr("each image needs its depth"));
  fs::remove_all(path_ + "/images");
  EXPECT_THAT(Error(), HasSubstr("/images: contains no image"));
}

// Real images, where they are there.
TEST(RgbdFolderReal, HoloLensViewsMakeAMap) {
  const std::string path = test::RecordingsPath("hololens");
  if (!fs::exists(path + "/poses.txt")) GTEST_SKIP() << "no " << path << "; set EVIT_SHARED_DATA";
  const RgbdFolder folder(path);
  ASSERT_EQ(folder.size(), 60u);
  RgbdFusion::Settings settings;
  settings.voxel = 0.02;
  RgbdFusion fusion(settings);
  for (std::size_t k = 0; k < 20; k += 4) fusion.Add(folder.Load(k));
  const PhotometricMap map = fusion.Finish();
  EXPECT_GT(map.points.size(), 10'000u);
  float least = 1, most = 0;
  for (const float i : map.intensities) least = std::min(least, i), most = std::max(most, i);
  EXPECT_LT(least, 0.2F);
  EXPECT_GT(most, 0.6F);
}

}  // namespace
}  // namespace evit::formats
