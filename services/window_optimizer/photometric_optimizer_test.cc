// EVPT's optimiser alone: event counts and views in, window states, modes and poses out, over the in-memory
// bus.
#include "services/window_optimizer/photometric_optimizer.h"

#include "common/photometric/view_renderer.h"
#include "common/wire/view_wire.h"
#include "tests/helpers/optimizer_peer.h"
#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

// Plays frame_builder and map_server, and keeps what the service says.
class PhotometricOptimizerTest : public test::OptimizerPeer {
 protected:
  static constexpr Utime kInterval = 20'000;

  static SE3 Truth(Utime t) {
    const double s = ToSeconds(t);
    return {ExpSO3({0.1 * std::sin(2 * s), 0.12 * std::sin(1.7 * s), 0.15 * std::sin(1.4 * s)}),
            0.1 * Eigen::Vector3d(std::sin(1.5 * s), std::sin(1.9 * s), std::sin(1.2 * s))};
  }
  void Start(bool lossless) {
    Listen();
    bus_->Subscribe(channels_.view_query,
                    [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                      view_query_t query;
                      ASSERT_TRUE(DecodeChecked(data, size, &query));
                      ++queries_;
                      if (map_server_up_) Answer(query);
                    });
    settings_.rig.camera = test::EventCamera();
    settings_.rig.T_body_camera = test::BodyCamera();
    settings_.T_map_body = Truth(1'000'000);
    settings_.lossless = lossless;
    service_ = std::make_unique<PhotometricOptimizer>(service_bus_.get(), channels_, settings_);
    Pump();
  }
  void Pump() {
    for (int k = 0; k < 4; ++k) {
      service_bus_->Poll(0);
      service_->Tick();
      bus_->Poll(0);
    }
  }
  void Answer(const view_query_t& query) {
    PhotometricView view;
    renderer_.Render(FromMessage(query), &view);
    map_view_t answer = ToMessage(view);
    answer.query_seq = query.seq;
    answer.query_epoch = query.epoch;
    answer.epoch = 5;
    answer.seq = answers_++;
    Send(channels_.map_view, answer);
  }
  keyframe_t Keyframe(Utime t) {
    const auto see = [&](Utime at) {
      return room_.See(settings_.rig.camera, Truth(at) * test::BodyCamera());
    };
    const cv::Mat counts = test::CountBetween(see(t - kInterval / 2), see(t + kInterval / 2), 0.33);
    keyframe_t k{};
    k.utime = t;
    k.previous_utime = keyframe_seq_ > 0 ? t - kInterval : t;
    k.seq = keyframe_seq_++;
    k.epoch = 77;
    k.n_events = 20'000;
    k.decay_us = 5000;
    k.encoding = keyframe_t::EVENT_COUNT;
    k.from_utime = t - kInterval / 2;
    k.lookahead_us = kInterval / 2;
    k.width = counts.cols;
    k.height = counts.rows;
    k.surface_size = k.width * k.height;
    k.surface.assign(counts.datastart, counts.dataend);
    return k;
  }
  std::int64_t Counter(const std::string& name) {
    service_->Stop();  // sends STATUS at once
    Pump();
    return LastCounter(name);
  }

  PhotometricOptimizer::Settings settings_;
  test::Room room_;
  ViewRenderer renderer_{room_.Map(0.015), test::Room::kDark};
  std::unique_ptr<PhotometricOptimizer> service_;
  std::int64_t keyframe_seq_ = 0, answers_ = 0;
  int queries_ = 0;
  bool map_server_up_ = true;
};

TEST_F(PhotometricOptimizerTest, TracksAndAnswersEveryKeyframe) {
  Start(true);
  constexpr int kFrames = 30;
  for (int k = 0; k < kFrames; ++k) {
    Send(channels_.keyframe, Keyframe(1'000'000 + k * kInterval));
    Pump();
  }
  ASSERT_EQ(modes_.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(modes_.back().mode, tracker_mode_t::TRACKING) << modes_.back().reason;
  EXPECT_EQ(modes_.back().keyframe_epoch, 77);
  EXPECT_GT(modes_.back().image_speed, 0);
  ASSERT_EQ(windows_.size(), modes_.size());
  EXPECT_EQ(poses_.size(), modes_.size());
  for (std::size_t k = 5; k < windows_.size(); ++k) {
    ASSERT_EQ(windows_[k].n_nodes, 1);
    const node_state_t& node = windows_[k].node[0];
    EXPECT_EQ(node.keyframe_seq, static_cast<std::int64_t>(k));
    EXPECT_LT((Eigen::Vector3d(node.position) - Truth(node.utime).p).norm(), 0.02);
    EXPECT_EQ(windows_[k].lookahead_us, kInterval / 2);
    EXPECT_EQ(poses_[k].position[1], node.position[1]);
  }
  EXPECT_EQ(queries_, kFrames + 1);
}

TEST_F(PhotometricOptimizerTest, LosslessWaitsForTheViewAndForTheKeyframeBefore) {
  map_server_up_ = false;
  Start(true);
  const keyframe_t first = Keyframe(1'000'000), second = Keyframe(1'000'000 + kInterval);
  Send(channels_.keyframe, second);  // out of order: dropped
  Send(channels_.keyframe, first);
  Pump();
  EXPECT_TRUE(modes_.empty());
  map_server_up_ = true;  // comes up late: the query is sent again
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (modes_.empty() && std::chrono::steady_clock::now() < give_up) Pump();
  ASSERT_EQ(modes_.size(), 1u);
  EXPECT_EQ(modes_[0].keyframe_seq, 0);
  Send(channels_.keyframe, second);
  Pump();
  Send(channels_.keyframe, second);  // its answer got lost
  Pump();
  ASSERT_EQ(modes_.size(), 3u);
  EXPECT_EQ(modes_[1].keyframe_seq, 1);
  EXPECT_EQ(modes_[2].keyframe_seq, 1);
  EXPECT_EQ(windows_.size(), 2u);
  EXPECT_EQ(Counter("KEYFRAME.out_of_order"), 1);
}

TEST_F(PhotometricOptimizerTest, RealTimeKeepsTheNewestKeyframes) {
  map_server_up_ = false;
  Start(false);
  for (int k = 0; k < 6; ++k) Send(channels_.keyframe, Keyframe(1'000'000 + k * kInterval));
  Pump();
  map_server_up_ = true;
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (modes_.size() < 2 && std::chrono::steady_clock::now() < give_up) Pump();
  ASSERT_EQ(modes_.size(), 2u);
  EXPECT_EQ(modes_[0].keyframe_seq, 4);
  EXPECT_EQ(modes_[1].keyframe_seq, 5);
  EXPECT_EQ(Counter("KEYFRAME.dropped"), 4);
}

TEST_F(PhotometricOptimizerTest, AHintRestartsIt) {
  Start(true);
  body_pose_t hint{};
  const SE3 there = Truth(1'000'000).Plus((Vector6d() << 0.5, 0, 0, 0, 0, 0).finished());
  for (int k = 0; k < 3; ++k) hint.position[k] = there.p[k];
  for (int k = 0; k < 4; ++k) hint.orientation[k] = there.q.coeffs()[k];
  const int before = queries_;
  Send(channels_.pose_hint, hint);
  Pump();
  EXPECT_EQ(queries_, before + 1);
}

TEST_F(PhotometricOptimizerTest, WrongKeyframesAndRubbishAreCountedAndSurvived) {
  Start(true);
  keyframe_t surface = Keyframe(1'000'000);
  surface.encoding = keyframe_t::TIME_SURFACE;
  Send(channels_.keyframe, surface);
  keyframe_t small = Keyframe(1'000'000);
  small.width = small.height = 16;
  small.surface_size = 256;
  small.surface.assign(256, 128);
  Send(channels_.keyframe, small);
  const std::vector<std::uint8_t> garbage(300, 0xab);
  for (const std::string& channel : {channels_.keyframe, channels_.map_view, channels_.pose_hint})
    bus_->Publish(channel, garbage.data(), garbage.size());
  map_view_t view{};  // an answer, but of another size
  view.query_epoch = statuses_.empty() ? 0 : statuses_.back().epoch;
  view.width = view.height = 2, view.size = 4, view.min_depth = 0.1;
  view.log_intensity.assign(4, 0), view.inverse_depth.assign(4, 0);
  Send(channels_.map_view, view);
  Pump();
  EXPECT_TRUE(modes_.empty());
  EXPECT_TRUE(std::any_of(statuses_.begin(), statuses_.end(), [](const service_status_t& m) {
    return m.state == "failed" && m.detail.find("--config") != std::string::npos;
  }));
  keyframe_seq_ = 0;
  Send(channels_.keyframe, Keyframe(1'000'000));
  Pump();
  EXPECT_EQ(modes_.size(), 1u);
  EXPECT_EQ(Counter("KEYFRAME.invalid"), 3);
  EXPECT_EQ(Counter("MAP_VIEW.invalid"), 1);
  EXPECT_EQ(Counter("POSE_HINT.invalid"), 1);
}

TEST_F(PhotometricOptimizerTest, AnotherCamerasKeyframesAreTurnedAway) {
  Start(true);
  keyframe_t small = Keyframe(1'000'000);
  small.width = small.height = 16;
  small.surface_size = 256;
  small.surface.assign(256, 128);
  Send(channels_.keyframe, small);
  Pump();
  EXPECT_TRUE(modes_.empty());
  EXPECT_EQ(statuses_.back().state, "failed");
  EXPECT_NE(statuses_.back().detail.find("--rig"), std::string::npos);
}

}  // namespace
}  // namespace evit
