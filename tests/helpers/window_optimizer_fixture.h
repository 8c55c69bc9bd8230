#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/wire/imu_wire.h"
#include "services/window_optimizer/window_optimizer.h"
#include "tests/helpers/optimizer_peer.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit::test {

/// Plays frame_builder and map_server.
class WindowOptimizerTest : public OptimizerPeer {
 protected:
  void Start(bool lossless) {
    Listen();
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
    settings.T_map_body = motion_.State(1.0).T_map_body;
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
      answer.x.push_back(room_[k].x()), answer.y.push_back(room_[k].y()), answer.z.push_back(room_[k].z());
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
    k.surface_size = 640 * 480;
    const cv::Mat image = synthetic::DrawSurface(alignment_, room_, motion_.State(ToSeconds(t)).T_map_body);
    k.surface.assign(image.datastart, image.dataend);
    for (const ImuSample& s : motion_.Samples(k.previous_utime, t, {})) {
      k.imu_utime.push_back(s.t);
      k.gyro.push_back({s.gyro.x(), s.gyro.y(), s.gyro.z()});
      k.accel.push_back({s.accel.x(), s.accel.y(), s.accel.z()});
    }
    k.n_imu = static_cast<std::int32_t>(k.imu_utime.size());
    k.imu_gap_us = 5000;
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

  // Until it tracks and ten keyframes more, with IMU messages that reach beyond.
  void TrackForAWhile() {
    const Utime begin = UntilTracking();
    SendImu(begin - 50'000, begin + 2'000'000);
    for (int k = 0; k < 10; ++k) {
      Send(channels_.keyframe, Keyframe(last_ + 25'000));
      Pump();
    }
  }

  void SendImu(Utime begin, Utime end) {
    std::int64_t seq = 0;
    for (Utime t = begin; t <= end; t += 5'000) {
      const ImuSample s = motion_.Imu(t, {});
      imu_batch_t m = ToMessage(s);
      m.seq = seq++;
      m.epoch = 3;
      Send(channels_.imu, m);
    }
    Pump();
  }

  std::int64_t Counter(const std::string& name) {
    service_->Stop();  // sends STATUS at once
    Pump();
    return LastCounter(name);
  }

  WindowOptimizer::Settings settings_;
  synthetic::Motion motion_;
  std::vector<Eigen::Vector3f> room_ = synthetic::RoomPoints();
  AlignmentSettings alignment_ = synthetic::Alignment();
  std::unique_ptr<WindowOptimizer> service_;
  Utime last_ = 0;
  std::int64_t keyframe_seq_ = 0, answers_ = 0;
  int queries_ = 0;
  bool map_server_up_ = true;
};

}  // namespace evit::test
