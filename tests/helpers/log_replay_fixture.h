#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/memory_bus.h"
#include "common/service/credit_sender.h"
#include "services/log_replay/log_replay.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/replay_recording.h"

namespace evit {

/// A LogReplay on a bus in memory, and a consumer that keeps what it hears.
class LogReplayTest : public ::testing::Test {
 protected:
  LogReplayTest() : path_(::testing::TempDir() + "log_replay_test.lcmlog"), hub_(MakeMemoryHub()) {
    options_.log = path_;
    options_.lossless = true;
    options_.wait_for = {"c"};
    options_.resend_us = 3'600'000'000;  // nothing gets lost here, and a slow host is not to send twice
    replay_bus_ = OpenMemoryBus(hub_);
    bus_ = OpenMemoryBus(hub_);
    test::Keep(bus_.get(), channels_.events, &events_);
    test::Keep(bus_.get(), channels_.imu, &imu_);
    test::Keep(bus_.get(), channels_.ground_truth, &truth_);
    test::Keep(bus_.get(), channels_.stream_end, &end_);
    test::Keep(bus_.get(), channels_.status, &status_);
  }
  ~LogReplayTest() override { std::filesystem::remove(path_); }

  void Credit() {
    credit_t credit{};
    credit.seq = credit_seq_++;
    credit.consumer = "c";
    credit.stream_epoch = events_.empty() ? -1 : events_.back().epoch;
    credit.next_events_seq = events_.empty() ? 0 : events_.back().seq + 1;
    credit.next_imu_seq = imu_.empty() ? 0 : imu_.back().seq + 1;
    test::Publish(bus_.get(), channels_.credit, credit);
  }
  void Order(int command, std::int64_t seek_utime = 0, double speed = 0) {
    replay_control_t order{};
    order.seq = order_seq_++;
    order.command = static_cast<std::int8_t>(command);
    order.seek_utime = seek_utime;
    order.speed = speed;
    test::Publish(bus_.get(), channels_.replay_control, order);
  }
  void Step(bool with_credit = true) {
    if (with_credit) Credit();
    replay_bus_->Poll(0);
    replay_->Tick();
    bus_->Poll(0);
  }
  /// Steps at log_replay's own pace until `holds`, but for no more than a minute.
  template <typename Condition>
  void StepUntil(const Condition& holds) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!holds() && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(replay_->poll_timeout_ms()));
      Step();
    }
  }
  void Start(const TestRecording& recording = {}) {
    WriteTestRecording(path_, recording);
    replay_ = std::make_unique<LogReplay>(options_, replay_bus_.get(), channels_);
  }
  std::int64_t Counter(const std::string& name) {
    const_cast<StatusReporter&>(replay_->status()).Publish();
    bus_->Poll(0);
    const service_status_t& status = status_.back();
    for (int i = 0; i < status.n_counters; ++i) {
      if (status.counter_name[i] == name) return status.counter_value[i];
    }
    return -1;
  }

  std::string path_;
  LogReplayOptions options_;
  std::shared_ptr<MemoryHub> hub_;
  std::unique_ptr<Bus> replay_bus_, bus_;
  Channels channels_;
  std::unique_ptr<LogReplay> replay_;
  std::vector<event_packet_t> events_;
  std::vector<imu_batch_t> imu_;
  std::vector<body_pose_t> truth_;
  std::vector<stream_end_t> end_;
  std::vector<service_status_t> status_;
  std::int64_t credit_seq_ = 0, order_seq_ = 0;
};

}  // namespace evit
