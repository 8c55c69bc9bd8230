// `evit map build` and what changes maps, the program.
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "common/wire/event_wire.h"
#include "tests/helpers/painted_events.h"
#include "tests/helpers/painted_scene.h"
#include "tests/helpers/run_evit.h"

namespace evit::commands {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

using Outcome = test::ProgramOutcome;

// Pictures of a painted wall with a camera file and poses, in a folder of the test's own.
class MapBuildTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(testing::TempDir()) / ("map_build_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "pictures");
    Camera camera;
    camera.width = 200, camera.height = 150;
    camera.fx = camera.fy = 150;
    camera.cx = 100, camera.cy = 75;
    std::ofstream(folder_ / "camera.textproto")
        << "camera {\n  model: \"plumb_bob\"\n  width: 200\n  height: 150\n  fx: 150\n  fy: 150\n  cx: 100\n"
           "  cy: 75\n  distortion: [0, 0, 0, 0]\n}\n";
    const PaintedScene scene = PaintedScene::Wall();
    Trajectory poses;
    for (const SE3& pose : PaintedScene::Poses(16, 0.35)) {
      const auto t = static_cast<Utime>(poses.size() + 1) * 100'000 + 1'600'000'000'000'000;
      char name[40];
      std::snprintf(name, sizeof name, "%02zu.png", poses.size());
      cv::imwrite((folder_ / "pictures" / name).string(), scene.Picture(camera, pose));
      poses.push_back({t, pose});
    }
    WriteTum((folder_ / "poses.tum").string(), poses);
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static std::string File(const std::string& name) { return (folder_ / name).string(); }

  static Outcome Map(const std::string& arguments) { return test::RunEvit("map " + arguments); }

  static Outcome Build(const std::string& pictures, const std::string& poses, const std::string& more = "") {
    return Map("build --images " + File(pictures) + " --poses " + File(poses) + " --camera " +
               File("camera.textproto") + " --out " + File("map.pcd") + " " + more);
  }

  static fs::path folder_;
};

fs::path MapBuildTest::folder_;

TEST_F(MapBuildTest, MakesAMapThatLiesOnTheEdges) {
  const Outcome outcome = Build("pictures", "poses.tum", "--poses-out " + File("fitted.tum"));
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("median sigma"));
  const PointMap map = LoadMap(File("map.pcd")).map;
  ASSERT_GT(map.points.size(), 500U);
  EXPECT_EQ(map.attributes.size(), map.points.size());
  const PaintedScene scene = PaintedScene::Wall();
  std::vector<double> errors;
  for (const Eigen::Vector3f& p : map.points) errors.push_back(scene.DistanceToEdge(p.cast<double>()));
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.005);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.02);
  EXPECT_EQ(ReadTum(File("fitted.tum")).size(), 16U);

  // The other commands on the map just made.
  EXPECT_EQ(Map("transform " + File("map.pcd") + " --transform '1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1' --out " +
                File("moved.ply"))
                .code,
            0);
  const PointMap moved = LoadMap(File("moved.ply")).map;
  ASSERT_EQ(moved.points.size(), map.points.size());
  EXPECT_NEAR(moved.points[3].x(), map.points[3].x() + 5, 1e-5);
  EXPECT_EQ(Map("merge " + File("map.pcd") + " " + File("moved.ply") + " --out " + File("both.pcd")).code, 0);
  EXPECT_GT(LoadMap(File("both.pcd")).map.points.size(), 1.5 * static_cast<double>(map.points.size()));
  EXPECT_EQ(Map("crop " + File("both.pcd") + " --box 2.5:,:,: --out " + File("right.pcd")).code, 0);
  for (const Eigen::Vector3f& p : LoadMap(File("right.pcd")).map.points) EXPECT_GE(p.x(), 2.5F);
  EXPECT_EQ(Map("crop " + File("both.pcd") + " --box 50:,:,: --out " + File("none.pcd")).code, 1);
  EXPECT_FALSE(fs::exists(File("none.pcd")));
  const Outcome info = Map("info " + File("map.pcd") + " --out " + File("views"));
  EXPECT_EQ(info.code, 0);
  EXPECT_THAT(info.output, HasSubstr("sigma"));
  EXPECT_TRUE(fs::exists(File("views/top.png")) && fs::exists(File("views/side.png")));
}

// One round on a circle before the wall, with a body that is not the camera and clocks that differ.
class MapOfEventsTest : public MapBuildTest {
 protected:
  static void SetUpTestSuite() {
    MapBuildTest::SetUpTestSuite();
    constexpr Utime kBegin = 1'600'000'000'000'000, kStep = 1'000;
    Rig rig;
    rig.camera.width = 200, rig.camera.height = 150;
    rig.camera.fx = rig.camera.fy = 150;
    rig.camera.cx = 100, rig.camera.cy = 75;
    rig.camera_time_offset = 7'000;
    rig.T_body_camera = SE3(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.02, -0.03, 0.05});
    rig.imu_rate_hz = 200;
    rig.imu_noise.gyro_density = rig.imu_noise.accel_density = 1e-3;
    rig.imu_noise.gyro_random_walk = rig.imu_noise.accel_random_walk = 1e-5;
    WriteRig(File("rig.textproto"), rig, "test", "");
    const std::vector<SE3> cameras = CircleOfPoses(216, 0.16);
    Trajectory body;
    for (std::size_t k = 0; k < cameras.size(); ++k)
      body.push_back({kBegin + static_cast<Utime>(k) * kStep, cameras[k] * rig.T_body_camera.Inverse()});
    WriteTum(File("body.tum"), body);
    const EventArray events =
        PaintedEvents(PaintedScene::Wall(), rig.camera, cameras, kBegin - rig.camera_time_offset, kStep);
    LogWriter log(File("events.lcmlog"));
    std::vector<std::uint8_t> bytes;
    std::int64_t seq = 0;
    for (std::size_t k = 0; k < events.size();) {
      const Utime t = events.t[k];
      k = EncodePacket(events, k, 1, seq++, &bytes);
      log.Write(t, "EVENTS", bytes.data(), bytes.size());
    }
    log.Close();
  }

  static Outcome OfEvents(const std::string& poses, const std::string& more = "") {
    return Map("build --events " + File("events.lcmlog") + " --poses " + File(poses) + " --rig " +
               File("rig.textproto") + " --out " + File("events.pcd") + " " + more);
  }
};

TEST_F(MapOfEventsTest, LiesOnTheEdges) {
  const Outcome outcome = OfEvents("body.tum");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const PointMap map = LoadMap(File("events.pcd")).map;
  ASSERT_GT(map.points.size(), 300U);
  const PaintedScene scene = PaintedScene::Wall();
  std::vector<double> errors;
  for (const Eigen::Vector3f& p : map.points) errors.push_back(scene.DistanceToEdge(p.cast<double>()));
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.01);

  // It compares well with a map of pictures of the same wall, and badly with itself moved by 5 cm.
  ASSERT_EQ(Build("pictures", "poses.tum").code, 0);
  const Outcome compared = Map("compare " + File("events.pcd") + " " + File("map.pcd") + " --json");
  ASSERT_EQ(compared.code, 0) << compared.output;
  const auto json = nlohmann::json::parse(compared.output);
  EXPECT_EQ(json["points"], map.points.size());
  EXPECT_LT(json["median_m"].get<double>(), 0.015);
  // All of the wall is 1 to 3 m from the path, nothing 5 m.
  const auto in_range =
      nlohmann::json::parse(Map("compare " + File("events.pcd") + " " + File("map.pcd") + " --poses " +
                                File("body.tum") + " --min-distance 1 --max-distance 3 --json")
                                .output);
  EXPECT_EQ(in_range["points"], map.points.size());
  EXPECT_EQ(in_range["median_m"], json["median_m"]);
  EXPECT_GT(in_range["median_share"].get<double>(), json["median_m"].get<double>() / 3);
  EXPECT_LT(in_range["median_share"].get<double>(), json["median_m"].get<double>());
  const Outcome far = Map("compare " + File("events.pcd") + " " + File("map.pcd") + " --poses " +
                          File("body.tum") + " --min-distance 5");
  EXPECT_EQ(far.code, 1);
  EXPECT_THAT(far.output, HasSubstr("holds no points 5 to 1000 m from the path"));
  ASSERT_EQ(Map("transform " + File("events.pcd") +
                " --transform '1 0 0 0 0 1 0 0.05 0 0 1 0 0 0 0 1' --out " + File("moved.pcd"))
                .code,
            0);
  const auto moved = nlohmann::json::parse(
      Map("compare " + File("moved.pcd") + " " + File("events.pcd") + " --json").output);
  EXPECT_GT(moved["beyond"].get<double>(), 0.9);
}

TEST_F(MapOfEventsTest, RefusesAnotherClockACameraAtRestAndWhatIsMissing) {
  std::ofstream(File("later.tum")) << "1700000000 0 0 0 0 0 0 1\n1700000000.1 0.1 0 0 0 0 0 1\n";
  std::ofstream(File("rest.tum")) << "1600000000 0 0 0 0 0 0 1\n1600000000.1 0 0 0 0 0 0 1\n";
  const std::pair<Outcome, std::string> refused[] = {
      {OfEvents("later.tum"), "another clock"},
      {OfEvents("rest.tum"), "barely moves"},
      {OfEvents("body.tum", "--seconds 5:6"), "no pose in the seconds"},
      {Map("build --events " + File("events.lcmlog") + " --out " + File("events.pcd")), "--poses and --rig"}};
  fs::remove(File("events.pcd"));
  for (const auto& [outcome, words] : refused) {
    EXPECT_NE(outcome.code, 0) << words;
    EXPECT_THAT(outcome.output, HasSubstr(words));
  }
  EXPECT_FALSE(fs::exists(File("events.pcd")));
}

TEST_F(MapBuildTest, PosesOfAMarkerInAWorldOfItsOwnBecomeTheCameras) {
  MountedCamera mounted;
  mounted.camera = LoadMountedCamera(File("camera.textproto")).camera;
  mounted.T_body_camera = SE3(ExpSO3({1.1, -0.4, 0.3}), {0.1, -0.05, 0.02});
  mounted.T_marker_body = SE3(ExpSO3({-0.2, 0.5, 1.3}), {0.02, 0.03, -0.04});
  mounted.time_offset = 8'000;
  WriteMountedCamera(File("mounted.textproto"), mounted, "");
  const SE3 T_map_world(ExpSO3({M_PI / 2, 0, 0}), {1, 2, 3});
  fs::create_directories(File("by_stamp"));
  Trajectory marker;
  for (const StampedPose& camera : ReadTum(File("poses.tum"))) {
    char name[60];
    std::snprintf(name, sizeof name, "by_stamp/%lld.%06lld.png", static_cast<long long>(camera.t / 1'000'000),
                  static_cast<long long>(camera.t % 1'000'000));
    char numbered[40];
    std::snprintf(numbered, sizeof numbered, "pictures/%02zu.png", marker.size());
    fs::copy_file(File(numbered), File(name));
    marker.push_back(
        {camera.t + mounted.time_offset,
         T_map_world.Inverse() * camera.pose * (mounted.T_marker_body * mounted.T_body_camera).Inverse()});
  }
  WriteTum(File("marker.tum"), marker);
  const std::string arguments = "build --images " + File("by_stamp") + " --poses " + File("marker.tum") +
                                " --poses-of marker --T-map-world '1 0 0 1 0 0 -1 2 0 1 0 3 0 0 0 1' --out " +
                                File("marker.pcd") + " --camera ";
  const Outcome outcome = Map(arguments + File("mounted.textproto"));
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  std::vector<double> errors;
  for (const Eigen::Vector3f& p : LoadMap(File("marker.pcd")).map.points)
    errors.push_back(PaintedScene::Wall().DistanceToEdge(p.cast<double>()));
  ASSERT_GT(errors.size(), 500U);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.005);

  const Outcome unmounted = Map(arguments + File("camera.textproto"));
  EXPECT_NE(unmounted.code, 0);
  EXPECT_THAT(unmounted.output, HasSubstr("T_body_camera"));
}

TEST_F(MapBuildTest, RefusesWhatMakesNoMapAndLeavesNothingBehind) {
  fs::remove(File("map.pcd"));
  fs::create_directories(File("capped"));
  for (int k = 0; k < 16; ++k)
    cv::imwrite(File("capped/" + std::to_string(100 + k) + ".png"), cv::Mat(150, 200, CV_8U, cv::Scalar(3)));
  fs::create_directories(File("two"));
  for (const char* name : {"00.png", "01.png"}) fs::copy_file(File("pictures/") + name, File("two/") + name);
  std::ofstream(File("short.tum")) << "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n";
  std::ofstream(File("other_clock.tum")) << "5 0 0 0 0 0 0 1\n6 0 0 0 0 0 0 1\n";
  fs::create_directories(File("stamped"));
  fs::copy_file(File("pictures/00.png"), File("stamped/1600000000.100000.png"));
  const std::pair<Outcome, std::string> refused[] = {
      {Build("capped", "poses.tum"), "lens was covered"},
      {Build("pictures", "short.tum"), "16 pictures, but"},
      {Build("two", "short.tum"), "needs three"},
      {Build("stamped", "other_clock.tum"), "another clock"},
      {Build("nowhere", "poses.tum"), "no such folder"},
      {Build("pictures", "poses.tum", "--frames 20:30"), "only 16 pictures"},
      {Build("pictures", "poses.tum", "--min-depth 5 --max-depth 2"), "--min-depth"},
      {Map("build --out " + File("map.pcd")), "--images"},
      {Map("build --images x --out map.txt"), ".pcd"},
      {Map("build --images x --out /not/there/map.pcd"),
       "--out /not/there/map.pcd: there is no folder /not/there"},
      {Map("build --images x --out /proc/map.pcd"), "nothing can be written to /proc"},
      {Map("build --images x --out " + File("map.pcd") + " --poses-out /proc/p.tum"),
       "--poses-out /proc/p.tum"},
      {Map("build --images x --poses " + File("pictures") + " --out map.pcd"), "is a folder"},
      {Map("build --images x --poses y --out map.pcd"), "--poses y: there is no such file"}};
  for (const auto& [outcome, words] : refused) {
    EXPECT_NE(outcome.code, 0) << words;
    EXPECT_THAT(outcome.output, HasSubstr(words));
  }
  EXPECT_FALSE(fs::exists(File("map.pcd")));
  EXPECT_FALSE(fs::exists(File("map.pcd.part")));
}

}  // namespace
}  // namespace evit::commands
