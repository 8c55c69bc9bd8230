#include "tools/simulation/simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/helpers/all_events.h"
#include "tools/formats/hdf5/h5_recording.h"
#include "tools/simulation/edge_map.h"
#include "tools/simulation/renderer.h"
#include "tools/simulation/room.h"

namespace evit::simulation {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// A small camera, so that a test takes no time; the marker body somewhere else than the IMU.
Rig SmallRig() {
  Rig rig;
  rig.camera.width = 160;
  rig.camera.height = 120;
  rig.camera.fx = rig.camera.fy = 82;
  rig.camera.cx = 79;
  rig.camera.cy = 60;
  rig.camera.distortion = {-0.03, 0.04, -0.0005, -0.001, 0};
  rig.T_body_camera = {ExpSO3(Eigen::Vector3d(1.1, -1.3, 1.2)), Eigen::Vector3d(0.13, 0.08, 0.02)};
  rig.T_marker_body = {ExpSO3(Eigen::Vector3d(-0.4, 0.9, 2)), Eigen::Vector3d(0.07, 0, -0.09)};
  rig.imu_noise = {7e-4, 1.3e-3, 7e-6, 6e-5};
  rig.imu_rate_hz = 200;
  return rig;
}

std::string Text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class SimulatorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("evit_simulator_test_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    settings_.trajectory.source = "builtin:fast";
    settings_.trajectory.duration_s = 0.6;
    settings_.out = (folder_ / "a").string();
    settings_.threads = 1;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Error(const SimulationSettings& settings) {
    try {
      Simulate(settings, rig_, "test", nullptr);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  Rig rig_ = SmallRig();
  SimulationSettings settings_;
  fs::path folder_;
};

EventArray ReadEvents(const fs::path& path) {
  formats::H5Recording recording({path.string()}, "");
  return AllEvents(&recording, 8192, 8192);
}

TEST_F(SimulatorTest, SameSeedGivesSameSequenceWithAnyThreads) {
  const SimulationSummary summary = Simulate(settings_, rig_, "test", nullptr);
  settings_.out = (folder_ / "b").string();
  settings_.threads = 3;
  Simulate(settings_, rig_, "test", nullptr);
  for (const char* file : {"fast1.synced.imu.txt", "fast1.synced.gt.txt", "fast1.synced.left_event.hdf5",
                           "truth.tum", "map.pcd", "rig.textproto"}) {
    EXPECT_FALSE(Text(folder_ / "a" / file).empty()) << file;
    EXPECT_TRUE(Text(folder_ / "a" / file) == Text(folder_ / "b" / file)) << file;
  }
  const EventArray a = ReadEvents(folder_ / "a" / "fast1.synced.left_event.hdf5");
  const EventArray b = ReadEvents(folder_ / "b" / "fast1.synced.left_event.hdf5");
  EXPECT_EQ(a.size(), summary.events.total());
  EXPECT_GT(a.size(), 10'000U);
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.p, b.p);
  EXPECT_TRUE(std::is_sorted(a.t.begin(), a.t.end()));
  settings_.seed = 2;
  settings_.out = (folder_ / "c").string();
  Simulate(settings_, rig_, "test", nullptr);
  EXPECT_NE(Text(folder_ / "a" / "map.pcd"), Text(folder_ / "c" / "map.pcd"));
}

TEST_F(SimulatorTest, ASimulatedRigIsKnownExactly) {
  rig_.T_body_camera_sigma.rotation.setConstant(0.01);
  Simulate(settings_, rig_, "test", nullptr);
  EXPECT_EQ(Text(folder_ / "a" / "rig.textproto").find("sigma"), std::string::npos);
}

// What an importer does with the marker's poses gives the body's.
TEST_F(SimulatorTest, GroundTruthLeadsToTheBody) {
  Simulate(settings_, rig_, "test", nullptr);
  const Trajectory marker = ReadTum((folder_ / "a" / "fast1.synced.gt.txt").string());
  const Trajectory truth = ReadTum((folder_ / "a" / "truth.tum").string());
  ASSERT_EQ(truth.size(), 121U);
  int compared = 0;
  for (const StampedPose& pose : marker) {
    SE3 expected;
    if (!PoseAt(truth, pose.t, &expected)) continue;
    const SE3 body = pose.pose * rig_.T_marker_body;
    EXPECT_LT((body.p - expected.p).norm(), 2e-4);
    EXPECT_LT(AngularDistance(body.q, expected.q), 1e-3);
    ++compared;
  }
  EXPECT_GT(compared, 60);
}

// Camera chain, stamps and map together: events come where the map's edges project at that time.
TEST_F(SimulatorTest, EventsLieOnTheProjectedEdges) {
  settings_.sensor.noise_hz = 0;
  settings_.sensor.hot_pixels = 0;
  const SimulationSummary summary = Simulate(settings_, rig_, "test", nullptr);
  const EventArray events = ReadEvents(folder_ / "a" / "fast1.synced.left_event.hdf5");
  const Trajectory truth = ReadTum((folder_ / "a" / "truth.tum").string());
  const Scene scene = MakeRoom(settings_.room.seed);
  const Renderer renderer(rig_.camera, scene);
  std::vector<double> distances;
  for (std::size_t k = 10; k + 10 < truth.size(); k += 20) {
    View view;
    renderer.Render(truth[k].pose * rig_.T_body_camera, &view);
    const std::vector<EdgePixel> edges = FindEdges(view, rig_.camera.width, rig_.camera.height, 0.05);
    const auto begin = std::lower_bound(events.t.begin(), events.t.end(), truth[k].t - 500);
    for (auto i = static_cast<std::size_t>(begin - events.t.begin());
         i < events.size() && events.t[i] < truth[k].t + 500; ++i) {
      double nearest = 1e9;
      for (const EdgePixel& edge : edges) {
        nearest = std::min(nearest, (edge.pixel - Eigen::Vector2d(events.x[i], events.y[i])).norm());
      }
      distances.push_back(nearest);
    }
  }
  ASSERT_GT(distances.size(), 200U);
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
  EXPECT_LT(distances[distances.size() / 2], 1.0);
  EXPECT_GT(summary.speed.mean, 50);
}

TEST_F(SimulatorTest, LampMakesABurst) {
  settings_.trajectory.source = "builtin:handheld";
  const SimulationSummary calm = Simulate(settings_, rig_, "test", nullptr);
  settings_.disturbances.lamp_off_s = 0.2;
  settings_.disturbances.lamp_on_s = 0.4;
  settings_.out = (folder_ / "b").string();
  const SimulationSummary burst = Simulate(settings_, rig_, "test", nullptr);
  const std::size_t pixels = std::size_t{160} * 120;
  EXPECT_GT(burst.events.negative, calm.events.negative + 2 * pixels);
  EXPECT_GT(burst.events.positive, calm.events.positive + 2 * pixels);
}

// Another map into the folder, and nothing else; and not for another sequence.
TEST_F(SimulatorTest, MapOnlyLeavesTheEventsAlone) {
  Simulate(settings_, rig_, "test", nullptr);
  const fs::path folder = folder_ / "a";
  const std::string map = Text(folder / "map.pcd"), events = Text(folder / "fast1.synced.left_event.hdf5"),
                    report = Text(folder / "simulation.json");
  settings_.map_only = true;
  EXPECT_EQ(Error(settings_), "");
  EXPECT_EQ(Text(folder / "map.pcd"), map);  // the same options give the same map
  settings_.map.holes = {0.5, 0.6};
  settings_.rgbd = true;
  EXPECT_EQ(Error(settings_), "");
  EXPECT_LT(Text(folder / "map.pcd").size(), map.size() * 6 / 10);
  EXPECT_TRUE(fs::exists(folder / "rgbd" / "images" / "00000.png"));
  EXPECT_EQ(Error(settings_), "");  // once more: rgbd/ is replaced
  EXPECT_EQ(Text(folder / "fast1.synced.left_event.hdf5"), events);
  EXPECT_EQ(Text(folder / "simulation.json"), report);
  SimulationSettings other = settings_;
  other.trajectory.variant = 2;
  EXPECT_THAT(Error(other), HasSubstr("another motion"));
  other = settings_;
  other.room.seed = 2;
  EXPECT_THAT(Error(other), HasSubstr("another room"));
  other = settings_;
  other.room.kind = RoomKind::kPlain;
  EXPECT_THAT(Error(other), HasSubstr("another room"));
  other = settings_;
  other.map.holes = {1.5, 0.6};
  EXPECT_THAT(Error(other), HasSubstr("share of holes"));
  other.out = (folder_ / "b").string();  // a folder of its own will do, too
  other.map.holes = {};
  EXPECT_EQ(Error(other), "");
  EXPECT_EQ(Text(folder_ / "b" / "map.pcd"), map);
  EXPECT_FALSE(fs::exists(folder_ / "b" / "truth.tum"));
}

TEST_F(SimulatorTest, BadSettingsLeaveNothingBehind) {
  SimulationSettings bad = settings_;
  bad.trajectory.source = "builtin:flying";
  EXPECT_THAT(Error(bad), HasSubstr("builtin:handheld"));
  bad = settings_;
  bad.sensor.threshold = -1;
  EXPECT_THAT(Error(bad), HasSubstr("contrast threshold"));
  bad = settings_;
  bad.trajectory.source = (folder_ / "none.tum").string();
  EXPECT_THAT(Error(bad), HasSubstr("none.tum"));
  EXPECT_TRUE(fs::is_empty(folder_));
  std::ofstream(folder_ / "file") << "x";
  bad = settings_;
  bad.out = (folder_ / "file").string();
  EXPECT_THAT(Error(bad), HasSubstr("folder is needed"));
  bad.out = (folder_ / "file" / "b").string();
  EXPECT_THAT(Error(bad), HasSubstr("cannot write"));
}

TEST_F(SimulatorTest, ClipOutsideTheFileIsRejected) {
  Simulate(settings_, rig_, "test", nullptr);
  SimulationSettings again = settings_;
  again.trajectory.source = (folder_ / "a" / "truth.tum").string();
  again.trajectory.frame = TrajectoryFrame::kBody;
  again.trajectory.begin_s = 0.3;
  again.trajectory.end_s = 4;
  again.out = (folder_ / "b").string();
  EXPECT_THAT(Error(again), HasSubstr("cannot cut out"));
  again.trajectory.begin_s = again.trajectory.end_s = 0;
  const SimulationSummary summary = Simulate(again, rig_, "test", nullptr);
  EXPECT_EQ(summary.name, "truth");
  EXPECT_LT(summary.motion.fit_rms_m, 1e-4);
}

}  // namespace
}  // namespace evit::simulation
