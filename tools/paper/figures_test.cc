#include "tools/paper/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "common/bus/codec.h"
#include "common/config/rig_file.h"
#include "tests/helpers/paper.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/sample_messages.h"
#include "tools/paper/motion_model_figure.h"
#include "tools/paper/trajectory_figure.h"
#include "tools/paper/window_figure.h"

namespace evit::paper {
namespace {

constexpr Utime kBegin = 1'642'661'138'000'000, kInterval = 20'000;

Rig TestRig() { return LoadRig(test::SourcePath("config/vector/rig.textproto")); }

// The body at a time: the camera looks along the map's x axis, moves along y with growing speed.
SE3 BodyAt(const Rig& rig, double s) {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return SE3(Eigen::Quaterniond(R), {0, 2 * s * s, 1.2}) * rig.T_body_camera.Inverse();
}

PointMap Wall() {
  PointMap map;
  for (int row = 0; row < 40; ++row) {
    for (int k = -40; k < 40; ++k) map.points.emplace_back(2, 0.05 * k, 0.2 + 0.05 * row);
  }
  return map;
}

// Ten keyframes and the windows after them, as `evit run --record` leaves them.
void WriteLog(const std::string& path, const Rig& rig) {
  LogWriter log(path);
  std::vector<std::uint8_t> bytes;
  for (int k = 0; k < 10; ++k) {
    keyframe_t keyframe = Sample<keyframe_t>(1);
    keyframe.utime = kBegin + k * kInterval;
    keyframe.seq = k;
    keyframe.previous_utime = keyframe.utime - kInterval;
    keyframe.width = rig.camera.width;
    keyframe.height = rig.camera.height;
    keyframe.surface_size = keyframe.width * keyframe.height;
    keyframe.surface.assign(keyframe.surface_size, 200);
    keyframe.n_imu = 5;
    keyframe.imu_utime.clear();
    keyframe.gyro.assign(5, {0, 0, 0});
    keyframe.accel.clear();
    for (int i = 0; i < 5; ++i) {
      keyframe.imu_utime.push_back(keyframe.previous_utime + i * kInterval / 4);
      const Eigen::Vector3d f = BodyAt(rig, 0).q.conjugate() * Eigen::Vector3d(0, 4, rig.gravity);
      keyframe.accel.push_back({f.x(), f.y(), f.z()});
    }
    EncodeTo(keyframe, &bytes);
    log.Write(keyframe.utime, "KEYFRAME", bytes.data(), bytes.size());
    window_state_t window = Sample<window_state_t>(1);
    window.utime = keyframe.utime;
    window.keyframe_seq = k;
    window.node.clear();
    for (int i = std::max(0, k - 4); i <= k; ++i) {
      node_state_t node = Sample<window_state_t>(1).node.at(0);
      node.utime = kBegin + i * kInterval;
      node.keyframe_seq = i;
      const SE3 pose = BodyAt(rig, 0.02 * i);
      const double q[4] = {pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()};
      std::copy(q, q + 4, node.orientation);
      for (int axis = 0; axis < 3; ++axis) {
        node.position[axis] = pose.p[axis];
        node.velocity[axis] = axis == 1 ? 4 * 0.02 * i : 0;
        node.gyro_bias[axis] = node.accel_bias[axis] = 0;
      }
      window.node.push_back(node);
    }
    window.n_nodes = static_cast<int>(window.node.size());
    EncodeTo(window, &bytes);
    log.Write(keyframe.utime, "WINDOW_STATE", bytes.data(), bytes.size());
  }
  log.Close();
}

TEST(Predictions, HigherOrdersPredictAcceleratedMotionBetter) {
  const TestFolder folder("paper_predictions");
  const Rig rig = TestRig();
  WriteLog(folder / "keyframes.lcmlog", rig);
  const KeyframeLog log(folder / "keyframes.lcmlog");
  ASSERT_EQ(log.windows().size(), 10U);
  RecordedKeyframe keyframe;
  ASSERT_TRUE(log.Read(9, &keyframe));
  EXPECT_FALSE(log.Has(10));
  const SE3 found = BodyAt(rig, 0.18);
  double off[3];
  for (int model = 0; model < 3; ++model) {
    const SE3 expected = PredictFrom(log.windows()[8], keyframe, model, rig.gravity);
    off[model] = (expected.p - found.p).norm();
  }
  // 2 t^2: a step of 0.0136 m, one step's change of it 0.0016 m, and what the IMU knows exactly.
  EXPECT_NEAR(off[0], 0.0136, 1e-6);
  EXPECT_NEAR(off[1], 0.0016, 1e-6);
  EXPECT_NEAR(off[2], 0, 1e-6);
  EXPECT_NEAR(MeanPixelDistance(rig, Wall().points, found, found), 0, 1e-9);
  // 13.6 mm seen from 2 m away.
  EXPECT_NEAR(MeanPixelDistance(rig, Wall().points, found, BodyAt(rig, 0.16)), rig.camera.fx * 0.0136 / 2,
              0.6);
}

TEST(Figures, KeyframeFiguresAreDrawnFromARecording) {
  const TestFolder folder("paper_figures");
  const Rig rig = TestRig();
  WriteLog(folder / "keyframes.lcmlog", rig);
  const KeyframeLog log(folder / "keyframes.lcmlog");
  const MapIndex map(Wall());
  DrawMotionModels(folder / "models.png", "a title", log, rig, map);
  DrawWindow(folder / "window.png", "a title", log, rig, map);
  const cv::Mat models = cv::imread(folder / "models.png"), window = cv::imread(folder / "window.png");
  ASSERT_FALSE(models.empty());
  ASSERT_FALSE(window.empty());
  // Map points are red: there are some in each of the four panels.
  const auto red = [](const cv::Mat& part) {
    int count = 0;
    for (auto it = part.begin<cv::Vec3b>(); it != part.end<cv::Vec3b>(); ++it)
      count += (*it)[2] > 200 && (*it)[0] < 80 ? 1 : 0;
    return count;
  };
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(red(models(cv::Rect((k % 2) * models.cols / 2, (k / 2) * models.rows / 2, models.cols / 2,
                                  models.rows / 2))),
              500);
  }
  EXPECT_GT(red(window(cv::Rect(0, window.rows - 200, window.cols, 200))), 500);
}

TEST(Figures, TrajectoriesEndWhereAMethodIsLost) {
  const TestFolder folder("paper_trajectories");
  Trajectory truth, half;
  for (int k = 0; k <= 400; ++k) {
    const double s = 0.01 * k;
    truth.push_back(
        {kBegin + Utime{10'000} * k, {ExpSO3(Eigen::Vector3d(0, 0, 0.1 * s)), {s, std::sin(s), 1}}});
    if (k <= 200) half.push_back(truth.back());
  }
  DrawTrajectories(folder / "t.png", "title", truth, {{"whole", truth}, {"half", half}, {"nothing", {}}});
  const cv::Mat picture = cv::imread(folder / "t.png");
  ASSERT_FALSE(picture.empty());
  // Of the second method (blue) the charts have nothing in their right quarter.
  const cv::Vec3b blue(190, 110, 30);
  const auto has = [&](int left, int right) {
    for (int y = 100; y < picture.rows; ++y) {
      for (int x = left; x < right; ++x) {
        if (picture.at<cv::Vec3b>(y, x) == blue) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has(80, 420));
  EXPECT_FALSE(has(600, 790));
}

TEST(Figures, UndrawableFigureGivesTheReason) {
  const TestFolder folder("paper_no_figures");
  PaperOptions options;
  options.config = test::SourcePath("config/paper.textproto");
  options.programs = test::ProgramPath("");
  options.out = folder / "out";
  for (const Figure& figure : DrawFigures(folder / "figures", MakePlan(options))) {
    EXPECT_TRUE(figure.file.empty());
    EXPECT_THAT(figure.caption, ::testing::HasSubstr("not drawn, "));
  }
}

}  // namespace
}  // namespace evit::paper
