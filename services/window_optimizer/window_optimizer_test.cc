// The service alone: recorded-like keyframes, map answers and IMU in, window states, modes and poses out.
// Over the in-memory bus, where every message is delivered; the real bus is in tests/.
#include "services/window_optimizer/window_optimizer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "common/bus/codec.h"
#include "common/bus/lcm_bus.h"
#include "common/config/config.h"
#include "common/tracking/synthetic_scene.h"

namespace evit {
namespace {

using synthetic::Motion;

// Plays frame_builder and map_server, and keeps what the service says.
class WindowOptimizerTest : public ::testing::Test {
 protected:
  void Start(bool lossless) {
    service_bus_ = OpenMemoryBus(hub_);
    bus_ = OpenMemoryBus(hub_);
    Keep<window_state_t>(channels_.window_state, &windows_);
    Keep<tracker_mode_t>(channels_.tracker_mode, &modes_);
    Keep<body_pose_t>(channels_.body_pose, &poses_);
    Keep<service_status_t>(channels_.status, &statuses_);
    bus_->Subscribe(channels_.map_query,
                    [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                      map_query_t query;
                      ASSERT_TRUE(DecodeChecked(data, size, &query));
                      ++queries_;
                      if (map_server_up_) Answer(query);
                    });
    WindowOptimizer::Settings& settings = settings_;
    settings.rig.camera = synthetic::VgaCamera();
    settings.rig.T_body_camera = synthetic::BodyCamera();
    settings.rig.imu_noise = {7e-4, 1.3e-3, 7e-6, 6e-5};
    settings.tracker = LoadTracker(std::string(EVIT_SOURCE_DIR) + "/config/tracker.textproto");
    settings.T_map_body = motion_.State(1.0).T_world_body;
    settings.lossless = lossless;
    service_ = std::make_unique<WindowOptimizer>(service_bus_.get(), channels_, settings);
    Pump();
  }

  // As if killed and started again: nobody called Stop().
  void StartAgain() {
    service_bus_ = OpenMemoryBus(hub_);
    service_ = std::make_unique<WindowOptimizer>(service_bus_.get(), channels_, settings_);
    Pump();
  }

  void WithCheckpoint() {
    settings_.checkpoint = ::testing::TempDir() + "evit_optimizer_" + std::to_string(::getpid());
    std::remove(settings_.checkpoint.c_str());
  }
  void TearDown() override {
    if (!settings_.checkpoint.empty()) std::remove(settings_.checkpoint.c_str());
  }

  template <typename Message>
  void Keep(const std::string& channel, std::vector<Message>* list) {
    bus_->Subscribe(channel, [list](const std::string&, const std::uint8_t* data, std::size_t size) {
      Message message;
      ASSERT_TRUE(DecodeChecked(data, size, &message));
      list->push_back(message);
    });
  }

  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(message, &bytes);
    bus_->Publish(channel, bytes.data(), bytes.size());
  }

  void Pump() {
    // In real time keyframes are worked on meanwhile.
    for (int k = 0; k < 6 || (service_->busy() && map_server_up_ && k < 2000); ++k) {
      service_bus_->Poll(0);
      service_->Tick();
      bus_->Poll(0);
      if (k >= 6) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

  void Answer(const map_query_t& query) {
    map_points_t answer{};
    answer.query_seq = query.seq;
    answer.query_epoch = query.epoch;
    answer.epoch = 5;
    answer.seq = answers_++;
    for (std::size_t k = 0; k < room_.size(); ++k) {
      answer.xyz.push_back({room_[k].x(), room_[k].y(), room_[k].z()});
      answer.id.push_back(static_cast<std::int32_t>(k));
    }
    answer.n = answer.n_visible = static_cast<std::int32_t>(room_.size());
    answer.map_size = answer.n;
    Send(channels_.map_points, answer);
  }

  keyframe_t Keyframe(Utime t) {
    keyframe_t k{};
    k.utime = t;
    k.previous_utime = last_ > 0 ? last_ : t;
    k.seq = keyframe_seq_++;
    k.epoch = 77;
    k.n_events = 20000;
    k.decay_us = 5000;
    k.width = 640;
    k.height = 480;
    k.n_surfaces = 1;
    k.surface_size = 640 * 480;
    const cv::Mat image = synthetic::DrawSurface(alignment_, room_, motion_.State(ToSeconds(t)).T_world_body);
    k.surface.assign(1, std::vector<std::uint8_t>(image.datastart, image.dataend));
    for (const ImuSample& s : motion_.Samples(k.previous_utime, t, {})) {
      k.imu_utime.push_back(s.t);
      k.gyro.push_back({s.gyro.x(), s.gyro.y(), s.gyro.z()});
      k.accel.push_back({s.accel.x(), s.accel.y(), s.accel.z()});
    }
    k.n_imu = static_cast<std::int32_t>(k.imu_utime.size());
    k.imu_gap_us = 5000;
    k.imu.begin_utime = k.previous_utime;
    k.imu.end_utime = t;
    k.imu.gamma[3] = 1;
    last_ = t;
    return k;
  }

  // Keyframes until the service tracks; returns the stamp of the last one.
  Utime UntilTracking() {
    Utime t = 1'000'000;
    while (t < 3'000'000 && (modes_.empty() || modes_.back().mode != tracker_mode_t::TRACKING)) {
      Send(channels_.keyframe, Keyframe(t));
      Pump();
      t += 10'000;
    }
    return last_;
  }

  void SendImu(Utime begin, Utime end) {
    std::int64_t seq = 0;
    for (Utime t = begin; t <= end; t += 5'000) {
      const ImuSample s = motion_.Imu(t, {});
      imu_batch_t m{};
      m.utime = t;
      m.seq = seq++;
      m.epoch = 3;
      m.n = 1;
      m.sample_utime = {t};
      m.gyro = {{s.gyro.x(), s.gyro.y(), s.gyro.z()}};
      m.accel = {{s.accel.x(), s.accel.y(), s.accel.z()}};
      Send(channels_.imu, m);
    }
    Pump();
  }

  std::int64_t Counter(const std::string& name) {
    service_->Stop();  // sends STATUS at once
    Pump();
    const auto& status = statuses_.back();
    for (int k = 0; k < status.n_counters; ++k) {
      if (status.counter_name[k] == name) return status.counter_value[k];
    }
    return 0;
  }

  WindowOptimizer::Settings settings_;
  Motion motion_;
  std::vector<Eigen::Vector3f> room_ = synthetic::RoomPoints();
  AlignmentSettings alignment_ = synthetic::Alignment();
  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  Channels channels_;
  std::unique_ptr<Bus> service_bus_, bus_;
  std::unique_ptr<WindowOptimizer> service_;
  std::vector<window_state_t> windows_;
  std::vector<tracker_mode_t> modes_;
  std::vector<body_pose_t> poses_;
  std::vector<service_status_t> statuses_;
  Utime last_ = 0;
  std::int64_t keyframe_seq_ = 0, answers_ = 0;
  int queries_ = 0;
  bool map_server_up_ = true;
};

TEST_F(WindowOptimizerTest, TracksAndAnswersEveryKeyframe) {
  Start(true);
  UntilTracking();
  for (int k = 0; k < 40; ++k) {
    Send(channels_.keyframe, Keyframe(last_ + 25'000));
    Pump();
  }
  ASSERT_EQ(modes_.size(), static_cast<std::size_t>(keyframe_seq_));
  for (std::size_t k = 0; k < modes_.size(); ++k)
    EXPECT_EQ(modes_[k].keyframe_seq, static_cast<std::int64_t>(k));
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_GT(modes_.back().image_speed, 0);
  ASSERT_FALSE(windows_.empty());
  const node_state_t& newest = windows_.back().node.back();
  EXPECT_EQ(newest.utime, last_);
  const SE3 truth = motion_.State(ToSeconds(last_)).T_world_body;
  EXPECT_LT((Eigen::Vector3d(newest.position) - truth.p).norm(), 0.006);
  EXPECT_GE(queries_, keyframe_seq_);
  ASSERT_GT(poses_.size(), 100U);  // IMU rate: five per keyframe of 25 ms
  for (std::size_t k = 1; k < poses_.size(); ++k) EXPECT_GT(poses_[k].utime, poses_[k - 1].utime);
}

TEST_F(WindowOptimizerTest, LosslessWaitsForTheMapServer) {
  map_server_up_ = false;
  Start(true);
  for (int k = 0; k < 5; ++k) {
    Send(channels_.keyframe, Keyframe(1'000'000 + k * 10'000));
    Pump();
  }
  EXPECT_TRUE(modes_.empty());
  map_server_up_ = true;  // comes up late: the query is sent again and everything goes on
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (modes_.size() < 5 && std::chrono::steady_clock::now() < give_up) Pump();
  EXPECT_EQ(modes_.size(), 5U);
}

TEST_F(WindowOptimizerTest, KeyframesOutOfOrderWaitAndDuplicatesAreAnsweredAgain) {
  Start(true);
  const keyframe_t first = Keyframe(1'000'000), second = Keyframe(1'010'000);
  Send(channels_.keyframe, second);
  Pump();
  EXPECT_TRUE(modes_.empty());
  Send(channels_.keyframe, first);
  Send(channels_.keyframe, second);
  Pump();
  ASSERT_EQ(modes_.size(), 2U);
  Send(channels_.keyframe, second);
  Pump();
  ASSERT_EQ(modes_.size(), 3U);
  EXPECT_EQ(modes_.back().keyframe_seq, 1);
}

TEST_F(WindowOptimizerTest, LostKeyframeIsBridgedFromItsOwnImu) {
  Start(false);
  const Utime begin = UntilTracking();
  SendImu(begin - 50'000, begin + 1'000'000);
  for (int k = 0; k < 20; ++k) {
    const keyframe_t message = Keyframe(last_ + 25'000);
    if (k % 5 == 2) continue;  // lost on the way
    Send(channels_.keyframe, message);
    Pump();
  }
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_EQ(Counter("KEYFRAME.bridged"), 4);
  EXPECT_EQ(Counter("KEYFRAME.lost"), 4);
}

TEST_F(WindowOptimizerTest, RestartedItGoesOnWithoutMissingAKeyframe) {
  WithCheckpoint();
  Start(false);
  const Utime begin = UntilTracking();
  SendImu(begin - 50'000, begin + 2'000'000);
  for (int k = 0; k < 10; ++k) {
    Send(channels_.keyframe, Keyframe(last_ + 25'000));
    Pump();
  }
  const std::int64_t last = modes_.back().keyframe_seq;
  service_.reset();
  std::vector<keyframe_t> missed;
  for (int k = 0; k < 6; ++k) missed.push_back(Keyframe(last_ + 25'000));  // nobody hears them
  modes_.clear();
  windows_.clear();
  StartAgain();
  ASSERT_FALSE(modes_.empty());  // it says where it was
  EXPECT_EQ(modes_[0].keyframe_seq, last);
  EXPECT_EQ(modes_[0].keyframe_epoch, 77);
  EXPECT_EQ(modes_[0].mode, tracker_mode_t::TRACKING);
  modes_.clear();
  Send(channels_.keyframe, Keyframe(last_ + 25'000));  // live, before those that are sent again
  Pump();
  EXPECT_TRUE(windows_.empty());
  for (const keyframe_t& keyframe : missed) Send(channels_.keyframe, keyframe);
  Pump();
  ASSERT_EQ(windows_.size(), 7U);
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    EXPECT_EQ(windows_[k].keyframe_seq, last + 1 + static_cast<std::int64_t>(k));
    EXPECT_EQ(windows_[k].mode, tracker_mode_t::TRACKING);
    const node_state_t& newest = windows_[k].node.back();
    const SE3 truth = motion_.State(ToSeconds(newest.utime)).T_world_body;
    EXPECT_LT((Eigen::Vector3d(newest.position) - truth.p).norm(), 0.006);
  }
  EXPECT_EQ(Counter("checkpoint.resumed"), 1);
  EXPECT_EQ(Counter("overload.level"), 0);
}

TEST_F(WindowOptimizerTest, RestartedWithoutThoseKeyframesItLooksWhereTheBodyMustBe) {
  WithCheckpoint();
  Start(false);
  const Utime begin = UntilTracking();
  SendImu(begin - 50'000, begin + 1'000'000);
  for (int k = 0; k < 10; ++k) {
    Send(channels_.keyframe, Keyframe(last_ + 25'000));
    Pump();
  }
  service_.reset();
  keyframe_seq_ = 0;  // frame_builder was restarted too: another epoch
  StartAgain();
  modes_.clear();
  for (int k = 0; k < 40 && (modes_.empty() || modes_.back().mode != tracker_mode_t::TRACKING); ++k) {
    keyframe_t keyframe = Keyframe(last_ + 10'000);
    keyframe.epoch = 78;
    keyframe.high_rate = 1;
    Send(channels_.keyframe, keyframe);
    Pump();
  }
  ASSERT_FALSE(modes_.empty());
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_EQ(Counter("checkpoint.used"), 1);
}

TEST_F(WindowOptimizerTest, OverloadTakesPointsThenKeyframesAndGivesThemBack) {
  Start(false);
  const Utime begin = UntilTracking();
  SendImu(begin - 50'000, begin + 8'000'000);
  Send(channels_.keyframe, Keyframe(last_ + 25'000));
  Pump();
  const int points = windows_.back().n_points;
  EXPECT_EQ(modes_.back().keyframe_stride, 1);
  bool fewer_points_before_sparser = false;
  for (int burst = 0; burst < 25; ++burst) {
    for (int k = 0; k < 8; ++k) Send(channels_.keyframe, Keyframe(last_ + 10'000));
    service_bus_->Poll(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // they wait
    for (int k = 0; k < 4; ++k) Pump();
    fewer_points_before_sparser |= windows_.back().n_points < points && modes_.back().keyframe_stride == 1;
  }
  EXPECT_TRUE(fewer_points_before_sparser);
  EXPECT_GT(modes_.back().keyframe_stride, 1);
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_GT(Counter("KEYFRAME.dropped"), 0);
  EXPECT_GT(Counter("overload.level"), 2);
  for (int k = 0; k < 450; ++k) {
    Send(channels_.keyframe, Keyframe(last_ + 10'000));
    Pump();
  }
  EXPECT_EQ(Counter("overload.level"), 0);
  EXPECT_EQ(modes_.back().keyframe_stride, 1);
  EXPECT_NEAR(windows_.back().n_points, points, 0.3 * points);
}

TEST_F(WindowOptimizerTest, BadMessagesAreCountedAndSurvived) {
  Start(false);
  std::vector<std::uint8_t> garbage(300, 0xab);
  for (const std::string& channel : {channels_.keyframe, channels_.map_points, channels_.imu}) {
    bus_->Publish(channel, garbage.data(), garbage.size());
  }
  keyframe_t nan = Keyframe(1'000'000);
  nan.accel[0][1] = std::nan("");
  Send(channels_.keyframe, nan);
  keyframe_t small = Keyframe(1'010'000);
  small.width = small.height = 16;
  small.surface_size = 256;
  small.surface.assign(1, std::vector<std::uint8_t>(256, 255));
  Send(channels_.keyframe, small);
  Pump();
  EXPECT_TRUE(modes_.empty());
  EXPECT_EQ(Counter("KEYFRAME.invalid"), 3);
  EXPECT_EQ(Counter("MAP_POINTS.invalid"), 1);
  EXPECT_EQ(Counter("IMU.invalid"), 1);
  EXPECT_TRUE(std::any_of(statuses_.begin(), statuses_.end(), [](const service_status_t& s) {
    return s.state == "failed" && s.detail.find("--rig") != std::string::npos;
  }));
  keyframe_seq_ = 2;
  UntilTracking();
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING);
}

}  // namespace
}  // namespace evit
