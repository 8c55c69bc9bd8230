#include "tools/run/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"

namespace evit::run {
namespace {

using ::testing::ElementsAre;

class RecorderTest : public ::testing::Test {
 protected:
  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    test::Publish(sender_.get(), channel, message);
    receiver_->Poll(0);
  }

  /// Nodes `first`..`last` at 10 ms steps; x of node k is 100 k + `x`.
  void SendWindow(int first, int last, double x) {
    window_state_t m{};
    m.seq = window_seq_++;
    m.mode = tracker_mode_t::TRACKING;
    for (int k = first; k <= last; ++k) {
      node_state_t node{};
      node.utime = Utime{10'000} * (k + 1);
      node.keyframe_seq = k;
      node.position[0] = 100 * k + x;
      node.orientation[3] = 1;
      m.node.push_back(node);
    }
    m.n_nodes = static_cast<int>(m.node.size());
    m.utime = m.node.back().utime;
    m.keyframe_seq = last;
    m.solve_ms = 4;
    m.covariance[0][4] = m.covariance[4][0] = last;
    Send(channels_.window_state, m);
  }
  void SendMode(std::int64_t keyframe, int mode, const std::string& reason) {
    tracker_mode_t m{};
    m.keyframe_stride = 1;
    m.seq = mode_seq_++;
    m.utime = 10'000 * (keyframe + 1);
    m.keyframe_seq = keyframe;
    m.mode = static_cast<std::int8_t>(mode);
    m.reason = reason;
    Send(channels_.tracker_mode, m);
  }
  void SendStatus(const std::string& service, const std::string& state, std::int64_t last_keyframe = -1) {
    service_status_t m{};
    m.service = service;
    m.state = state;
    m.progress = 0.25;
    m.n_counters = 1;
    m.counter_name = {"last_keyframe_seq"};
    m.counter_value = {last_keyframe};
    Send(channels_.status, m);
  }

  static std::vector<double> Xs(const Trajectory& trajectory) {
    std::vector<double> xs;
    for (const StampedPose& s : trajectory) xs.push_back(s.pose.p.x());
    return xs;
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> sender_ = OpenMemoryBus(hub_), receiver_ = OpenMemoryBus(hub_);
  Channels channels_{"p."};
  Recorder recorder_{receiver_.get(), channels_};
  std::int64_t window_seq_ = 0, mode_seq_ = 0;
};

TEST_F(RecorderTest, OnlineIsTheFirstEstimateSmoothedTheLast) {
  SendWindow(0, 2, 0.1);
  SendWindow(1, 3, 0.2);
  SendWindow(3, 4, 0.3);  // two leave at once
  EXPECT_THAT(Xs(recorder_.online()), ElementsAre(200.1, 300.2, 400.3));
  EXPECT_THAT(Xs(recorder_.smoothed()), ElementsAre(0.1, 100.2, 200.2, 300.3, 400.3));
  EXPECT_EQ(recorder_.mean_solve_ms(), 4);
}

TEST_F(RecorderTest, CovariancesAreInStepWithTheOnlinePoses) {
  SendWindow(0, 2, 0.1);
  SendWindow(0, 2, 0.2);  // repeated
  SendWindow(1, 3, 0.2);
  ASSERT_EQ(recorder_.covariances().size(), recorder_.online().size());
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(recorder_.covariances()[k].t, recorder_.online()[k].t);
    EXPECT_EQ(recorder_.covariances()[k].covariance(0, 4), 2.0 + static_cast<double>(k));
  }
  recorder_.StartOver();
  EXPECT_TRUE(recorder_.covariances().empty());
}

TEST_F(RecorderTest, TwoPipelinesOnOneBusAreNoticed) {
  const auto status = [&](std::int64_t epoch) {
    service_status_t m{};
    m.service = "frame_builder";
    m.state = "running";
    m.epoch = epoch;
    Send(channels_.status, m);
  };
  for (const std::int64_t epoch : {1, 1, 2, 2, 3}) status(epoch);  // restarts
  EXPECT_EQ(recorder_.two_senders(), "");
  for (int k = 0; k < 4; ++k) status(7), status(8);
  EXPECT_EQ(recorder_.two_senders(), "frame_builder");
}

TEST_F(RecorderTest, RepeatedOrOlderStatesAddNothing) {
  SendWindow(0, 2, 0.1);
  SendWindow(0, 2, 0.2);
  SendWindow(0, 1, 0.3);
  EXPECT_THAT(Xs(recorder_.online()), ElementsAre(200.1));
}

TEST_F(RecorderTest, WindowThatStartsAgainKeepsTimeOrder) {
  SendWindow(0, 2, 0.1);
  SendWindow(9, 9, 0.1);  // after LOST
  SendWindow(9, 10, 0.2);
  const Trajectory smoothed = recorder_.smoothed();
  EXPECT_THAT(Xs(smoothed), ElementsAre(0.1, 100.1, 200.1, 900.2, 1000.2));
  for (std::size_t k = 1; k < smoothed.size(); ++k) EXPECT_LT(smoothed[k - 1].t, smoothed[k].t);
}

TEST_F(RecorderTest, ModeChangesAreKeptWithTheirReasons) {
  EXPECT_EQ(recorder_.n_keyframes(), 0);
  SendMode(0, tracker_mode_t::BOOTSTRAPPING, "start");
  SendMode(1, tracker_mode_t::BOOTSTRAPPING, "start");
  SendMode(2, tracker_mode_t::TRACKING, "bootstrapped");
  SendMode(3, tracker_mode_t::LOST, "dark");
  ASSERT_EQ(recorder_.mode_changes().size(), 3U);
  EXPECT_EQ(recorder_.mode_changes()[2].reason, "dark");
  EXPECT_EQ(recorder_.mode_changes()[1].t, 30'000);
  EXPECT_EQ(recorder_.n_keyframes(), 4);
}

TEST_F(RecorderTest, FinishedWhenDrainedAndAnswered) {
  SendMode(6, tracker_mode_t::TRACKING, "");
  SendStatus("frame_builder", "running", 6);
  EXPECT_FALSE(recorder_.Finished());
  SendStatus("frame_builder", "drained", 7);
  EXPECT_FALSE(recorder_.Finished());
  SendMode(7, tracker_mode_t::TRACKING, "");
  EXPECT_TRUE(recorder_.Finished());
}

TEST_F(RecorderTest, DrainedWithoutAnyKeyframeIsFinishedToo) {
  SendStatus("frame_builder", "drained", -1);
  EXPECT_TRUE(recorder_.Finished());
}

TEST_F(RecorderTest, ProgressAndActivity) {
  EXPECT_EQ(recorder_.progress(), 0);
  SendStatus("log_replay", "running");
  EXPECT_EQ(recorder_.progress(), 0.25);
  EXPECT_FALSE(recorder_.TakeActivity());  // a heartbeat is not progress
  SendWindow(0, 0, 0);
  EXPECT_TRUE(recorder_.TakeActivity());
  EXPECT_FALSE(recorder_.TakeActivity());
  SendMode(7, tracker_mode_t::TRACKING, "restarted: waiting");
  EXPECT_TRUE(recorder_.TakeActivity());
  SendMode(7, tracker_mode_t::TRACKING, "restarted: waiting");
  EXPECT_FALSE(recorder_.TakeActivity());  // nor is the same said again
}

TEST_F(RecorderTest, MalformedMessagesAreIgnored) {
  for (const std::string& channel : {channels_.window_state, channels_.tracker_mode, channels_.status}) {
    sender_->Publish(channel, "rubbish", 7);
  }
  receiver_->Poll(0);
  EXPECT_TRUE(recorder_.online().empty());
  EXPECT_TRUE(recorder_.statuses().empty());
}

}  // namespace
}  // namespace evit::run
