#include "tools/monitor/pipeline_watch.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "common/bus/memory_bus.h"
#include "common/wire/geometry_wire.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/sample_map_messages.h"

namespace evit::monitor {
namespace {

struct Recorder : PipelineListener {
  void OnPose(const body_pose_t& pose) override { poses.push_back(pose); }
  void OnMode(const tracker_mode_t& mode) override { modes.push_back(mode); }
  void OnPicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& overlay) override {
    keyframes.push_back(keyframe.utime);
    points = overlay;
  }
  bool WantsPicture() const override { return wants; }

  std::vector<body_pose_t> poses;
  std::vector<tracker_mode_t> modes;
  std::vector<std::int64_t> keyframes;
  std::vector<OverlayPoint> points;
  bool wants = true;
};

class PipelineWatchTest : public ::testing::Test {
 protected:
  PipelineWatchTest() { watch_.AddListener(&seen_); }

  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    test::Publish(bus_.get(), channel, message);
    bus_->Poll(0);
  }

  // A keyframe of an 80 x 60 camera without any event but at (40, 30).
  keyframe_t MakeKeyframe(std::int64_t utime) {
    keyframe_t m = Sample<keyframe_t>();
    m.utime = utime;
    m.previous_utime = m.from_utime = utime;
    m.encoding = keyframe_t::TIME_SURFACE;
    m.n_imu = 0;
    m.imu_utime.clear();
    m.gyro.clear();
    m.accel.clear();
    m.width = 80;
    m.height = 60;
    m.surface_size = 80 * 60;
    m.surface.assign(m.surface_size, 255);
    m.surface[size_t{30} * 80 + 40] = 7;
    return m;
  }

  window_state_t MakeWindow(std::int64_t utime, const SE3& T_map_body) {
    window_state_t m = Sample<window_state_t>();
    m.utime = utime;
    m.mode = tracker_mode_t::TRACKING;
    m.n_nodes = 1;
    m.node.resize(1);
    m.node[0].utime = utime;
    PutPose(T_map_body, &m.node[0]);
    return m;
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_);
  Channels channels_;
  PipelineWatch watch_{bus_.get(), channels_};
  Recorder seen_;
};

TEST_F(PipelineWatchTest, HandsOnWhatIsValidAndCountsTheRest) {
  body_pose_t pose = Sample<body_pose_t>();
  pose.seq = 0;
  Send(channels_.body_pose, pose);
  pose.seq = 4;
  Send(channels_.body_pose, pose);
  const std::string garbage = "no pose";
  bus_->Publish(channels_.body_pose, garbage.data(), garbage.size());
  pose.orientation[0] = 5;
  Send(channels_.body_pose, pose);
  EXPECT_EQ(seen_.poses.size(), 2U);
  const ChannelWatch::Figures figures = watch_.channels().channels().at(channels_.body_pose);
  EXPECT_EQ(figures.received, 2);
  EXPECT_EQ(figures.lost, 3);
  EXPECT_EQ(figures.invalid, 2);
}

TEST_F(PipelineWatchTest, ServicesThatShareAChannelAreNoLoss) {
  service_status_t status = Sample<service_status_t>();
  for (int seq = 0; seq < 3; ++seq) {
    for (const char* name : {"map_server", "log_replay"}) {
      status.service = name;
      status.epoch = name == std::string_view("map_server") ? 1 : 2;
      status.seq = seq;
      Send(channels_.status, status);
    }
  }
  const ChannelWatch::Figures figures = watch_.channels().channels().at(channels_.status);
  EXPECT_EQ(figures.lost, 0);
  EXPECT_EQ(figures.restarts, 0);
  EXPECT_EQ(watch_.services().size(), 2U);
}

TEST_F(PipelineWatchTest, AMapPointLiesWhereTheEstimateProjectsIt) {
  Camera camera;
  camera.width = 80;
  camera.height = 60;
  camera.fx = camera.fy = 50;
  camera.cx = 40;
  camera.cy = 30;
  watch_.mount()->Set(camera, SE3(Eigen::Quaterniond::Identity(), {0, 0, 0.5}));
  map_points_t answer = Sample<map_points_t>(2);
  answer.x = {1, 100}, answer.y = {2, 2}, answer.z = {5.5F, 5.5F};  // straight ahead, and outside the image
  Send(channels_.map_points, answer);
  Send(channels_.window_state, MakeWindow(1000, SE3()));  // somebody estimates
  Send(channels_.keyframe, MakeKeyframe(2000));
  EXPECT_TRUE(seen_.keyframes.empty());  // its estimate has not come
  Send(channels_.window_state, MakeWindow(2000, SE3(Eigen::Quaterniond::Identity(), {1, 2, 0})));
  ASSERT_EQ(seen_.keyframes, std::vector<std::int64_t>{2000});
  ASSERT_EQ(seen_.points.size(), 1U);
  EXPECT_NEAR(seen_.points[0].x, 40, 1e-4);
  EXPECT_NEAR(seen_.points[0].y, 30, 1e-4);
  EXPECT_EQ(seen_.points[0].residual, 7);
}

TEST_F(PipelineWatchTest, WithoutATrackerKeyframesAreShownAsTheyAre) {
  Send(channels_.keyframe, MakeKeyframe(1000));
  EXPECT_EQ(seen_.keyframes.size(), 1U);
  EXPECT_TRUE(seen_.points.empty());
}

TEST_F(PipelineWatchTest, NothingIsMadeForNobody) {
  seen_.wants = false;
  Send(channels_.keyframe, MakeKeyframe(1000));
  EXPECT_TRUE(seen_.keyframes.empty());
}

TEST_F(PipelineWatchTest, TheCamerasPlaceIsLearntFromQueries) {
  const SE3 T_body_camera(Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY())),
                          {0.1, 0, 0.05});
  for (int i = 0; i < 20; ++i) {
    const SE3 T_map_body(Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ())),
                         {0.2 * i, 1, 2});
    map_query_t query = Sample<map_query_t>();
    query.utime = int64_t{1000} * i;
    PutPose(T_map_body * T_body_camera, &query);
    Send(channels_.map_query, query);
    Send(channels_.window_state, MakeWindow(query.utime, T_map_body));
  }
  ASSERT_TRUE(watch_.mount()->T_body_camera());
  EXPECT_LT((watch_.mount()->T_body_camera()->p - T_body_camera.p).norm(), 1e-6);
  EXPECT_LT(AngularDistance(watch_.mount()->T_body_camera()->q, T_body_camera.q), 1e-6);
}

TEST_F(PipelineWatchTest, TheMapGrowsByPointsThatWereNotKnown) {
  map_points_t answer = Sample<map_points_t>(2);
  answer.map_size = 100;
  answer.id = {3, 99};
  Send(channels_.map_points, answer);
  answer.id = {99, 5};
  Send(channels_.map_points, answer);
  EXPECT_EQ(watch_.map()->points().size(), 3U);
  const std::uint32_t generation = watch_.map()->generation();
  answer.map_size = 50;
  answer.id = {0, 1};
  Send(channels_.map_points, answer);
  EXPECT_NE(watch_.map()->generation(), generation);
  EXPECT_EQ(watch_.map()->points().size(), 2U);
}

}  // namespace
}  // namespace evit::monitor
