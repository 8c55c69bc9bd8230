#include "tools/simulation/rgbd_views.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "common/config/rig_file.h"
#include "tools/simulation/builtin_motion.h"
#include "tools/simulation/camera_frames.h"
#include "tools/simulation/load_motion.h"
#include "tools/simulation/place_in_room.h"
#include "tools/simulation/room.h"

namespace evit::simulation {
namespace {

namespace fs = std::filesystem;

class RgbdViewsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("evit_rgbd_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    rig_.camera.width = 160;
    rig_.camera.height = 120;
    rig_.camera.fx = 82;
    rig_.camera.fy = 83;
    rig_.camera.cx = 79;
    rig_.camera.cy = 60;
    rig_.camera.distortion = {-0.03, 0.04, -0.0005, -0.001, 0};
    rig_.T_body_camera = {ExpSO3(Eigen::Vector3d(1.1, -1.3, 1.2)), Eigen::Vector3d(0.13, 0.08, 0.02)};
    MotionSettings trajectory;
    trajectory.source = "builtin:handheld";
    trajectory.duration_s = 3;
    motion_ = LoadMotion(trajectory, rig_);
    PlaceInRoom(rig_, scene_, &motion_);
    times_ = ChooseMapViews(motion_.spline, motion_.begin, motion_.end, settings_);
    ASSERT_GE(times_.size(), 2U);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // As any reader of this layout does it: files in the order of their names, row i of the poses for file i.
  struct Read {
    std::vector<cv::Mat> images, depth;
    std::vector<Eigen::Matrix4d> poses;
    Eigen::Matrix3d k;
  };
  Read WriteAndRead(std::uint64_t seed) {
    fs::remove_all(folder_);
    WriteRgbdViews(folder_.string(), scene_, rig_, motion_.spline, times_, settings_, seed, 2);
    Read read;
    for (const auto& [part, list] : {std::pair{"images", &read.images}, std::pair{"depth", &read.depth}}) {
      std::vector<fs::path> files;
      for (const auto& entry : fs::directory_iterator(folder_ / part)) files.push_back(entry.path());
      std::sort(files.begin(), files.end());
      for (const fs::path& file : files) list->push_back(cv::imread(file.string(), cv::IMREAD_UNCHANGED));
    }
    std::ifstream poses(folder_ / "poses.txt"), k(folder_ / "K.txt");
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m;
    int n = 0;
    for (double value = 0; poses >> value;) {
      m.data()[n++ % 16] = value;
      if (n % 16 == 0) read.poses.emplace_back(m);
    }
    EXPECT_EQ(n % 16, 0);
    for (int i = 0; i < 9; ++i) k >> read.k(i / 3, i % 3);
    return read;
  }

  fs::path folder_;
  Rig rig_;
  Scene scene_ = MakeRoom(2);
  Motion motion_;
  MapSettings settings_;
  std::vector<Utime> times_;
};

// Depth, pose and K put every pixel where its ray meets the room.
TEST_F(RgbdViewsTest, PixelsComeBackToTheRoom) {
  settings_.depth_noise = settings_.view_jitter_m = 0;
  const Read read = WriteAndRead(1);
  ASSERT_EQ(read.images.size(), times_.size());
  ASSERT_EQ(read.depth.size(), times_.size());
  ASSERT_EQ(read.poses.size(), times_.size());
  EXPECT_NEAR(read.k(0, 0), 82, 1e-9);
  EXPECT_NEAR(read.k(1, 2), 60, 1e-9);
  int wrong = 0, n = 0;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    ASSERT_EQ(read.images[i].type(), CV_8U);
    ASSERT_EQ(read.depth[i].type(), CV_16U);
    ASSERT_EQ(read.images[i].size(), cv::Size(160, 120));
    const Eigen::Matrix3d R = read.poses[i].topLeftCorner<3, 3>();
    const Eigen::Vector3d p = read.poses[i].topRightCorner<3, 1>();
    for (int y = 0; y < 120; y += 7) {
      for (int x = 0; x < 160; x += 7, ++n) {
        const Eigen::Vector3d ray = read.k.inverse() * Eigen::Vector3d(x, y, 1);
        const double depth = 1e-3 * read.depth[i].at<std::uint16_t>(y, x);
        const Hit hit = CastRay(scene_, p, R * ray);
        if (std::abs(hit.depth - depth) > 0.5e-3 + 1e-3 * hit.depth) ++wrong;
      }
    }
  }
  EXPECT_LT(wrong, n / 200);  // rays that pass a border within rounding
}

// A point seen in two views has the same grey in both: the light of the room does not depend on the view.
TEST_F(RgbdViewsTest, ViewsAgreeOnTheGrey) {
  settings_.depth_noise = settings_.view_jitter_m = 0;
  const Read read = WriteAndRead(1);
  const Eigen::Matrix4d T_b_a = read.poses[1].inverse() * read.poses[0];
  double difference = 0, shuffled = 0;
  int n = 0;
  for (int y = 5; y < 115; y += 3) {
    for (int x = 5; x < 155; x += 3) {
      const double depth = 1e-3 * read.depth[0].at<std::uint16_t>(y, x);
      const Eigen::Vector3d a = depth * (read.k.inverse() * Eigen::Vector3d(x, y, 1));
      const Eigen::Vector3d b = (T_b_a * a.homogeneous()).head<3>();
      if (b.z() < 0.1) continue;
      const Eigen::Vector3d pixel = read.k * b / b.z();
      const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
      if (u < 0 || v < 0 || u >= 160 || v >= 120) continue;
      if (std::abs(1e-3 * read.depth[1].at<std::uint16_t>(v, u) - b.z()) > 0.05) continue;  // hidden
      difference += std::abs(read.images[0].at<uchar>(y, x) - read.images[1].at<uchar>(v, u));
      shuffled += std::abs(read.images[0].at<uchar>(y, x) - read.images[1].at<uchar>(v, (u + 40) % 160));
      ++n;
    }
  }
  ASSERT_GT(n, 500);
  EXPECT_LT(difference / n, 12);
  EXPECT_LT(difference, 0.4 * shuffled);
}

TEST_F(RgbdViewsTest, HasTheMapsErrors) {
  settings_.view_jitter_m = 0.01;
  settings_.depth_noise = 0.02;
  const Read noisy = WriteAndRead(3);
  settings_.depth_noise = 0;
  const Read clean = WriteAndRead(3);
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const Eigen::Vector3d moved =
        noisy.poses[i].topRightCorner<3, 1>() - (motion_.spline.Pose(times_[i]) * rig_.T_body_camera).p;
    EXPECT_LT((moved - ViewMisplacement(settings_, 3, static_cast<int>(i))).norm(), 1e-9);
    EXPECT_GT(moved.norm(), 1e-4);
  }
  double sum = 0;
  int n = 0;
  for (int i = 0; i < 160 * 120; ++i) {
    const double a = clean.depth[0].ptr<std::uint16_t>()[i], b = noisy.depth[0].ptr<std::uint16_t>()[i];
    if (a == 0) continue;
    sum += std::pow(b / a - 1, 2);
    ++n;
  }
  EXPECT_NEAR(std::sqrt(sum / n), 0.02, 0.002);
}

TEST_F(RgbdViewsTest, UnwritableFolderIsNamed) {
  std::ofstream(folder_) << "a file";
  EXPECT_THROW(WriteRgbdViews(folder_.string(), scene_, rig_, motion_.spline, times_, settings_, 1, 1),
               std::runtime_error);
}

TEST_F(RgbdViewsTest, ARegularCamerasPicturesHaveStampsPosesAndACalibration) {
  FrameSettings settings;
  settings.rate_hz = 10;
  settings.scale = 0.5;
  settings.exposure_ms = 0;
  settings.grey_noise = 0;
  rig_.T_marker_body = {ExpSO3(Eigen::Vector3d(0.2, 0.1, -0.3)), Eigen::Vector3d(0.01, 0.02, 0.03)};
  WriteCameraFrames(folder_.string(), scene_, rig_, motion_.spline, motion_.begin, motion_.begin + 300'000,
                    settings, 1, 2, [](double) {});
  const MountedCamera camera = LoadMountedCamera((folder_ / "camera.textproto").string());
  EXPECT_TRUE(camera.mounted);
  EXPECT_LT((camera.T_marker_body.p - rig_.T_marker_body.p).norm(), 1e-9);
  EXPECT_EQ(camera.camera.width, 80);
  const Trajectory poses = ReadTum((folder_ / "camera_poses.tum").string());
  ASSERT_EQ(poses.size(), 4U);
  const Renderer renderer(camera.camera, scene_);
  for (const StampedPose& pose : poses) {
    char name[40];
    std::snprintf(name, sizeof name, "camera/%lld.%06lld.png", static_cast<long long>(pose.t / 1'000'000),
                  static_cast<long long>(pose.t % 1'000'000));
    const cv::Mat picture = cv::imread((folder_ / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(picture.size(), cv::Size(80, 60)) << name;
    View view;
    renderer.Render(pose.pose, &view);
    double off = 0;  // of the grey levels, where the camera says it was
    for (std::size_t i = 0; i < view.image.size(); ++i)
      off += std::abs(255 * std::pow(view.image[i] / 255.0, 1 / settings.gamma) - picture.data[i]);
    EXPECT_LT(off / static_cast<double>(view.image.size()), 0.6);
  }
}

}  // namespace
}  // namespace evit::simulation
