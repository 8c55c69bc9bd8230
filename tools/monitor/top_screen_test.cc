#include "tools/monitor/top_screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/sample_messages.h"

namespace evit::monitor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class TopScreenTest : public ::testing::Test {
 protected:
  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    test::Publish(bus_.get(), channel, message);
    bus_->Poll(0);
  }
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  Channels channels_;
  PipelineWatch watch_{bus_.get(), channels_};
  procman::Sheriff sheriff_{bus_.get()};
  TopScreen screen_{&watch_, &sheriff_};
};

TEST_F(TopScreenTest, SaysThatNothingWasHeard) {
  EXPECT_THAT(screen_.Draw(80, 24, false), HasSubstr("no word of the tracker yet"));
}

TEST_F(TopScreenTest, ShowsModePoseServicesAndChannels) {
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.mode = tracker_mode_t::LOST;
  mode.reason = "coasted too long";
  Send(channels_.tracker_mode, mode);
  Send(channels_.body_pose, Sample<body_pose_t>());
  service_status_t status = Sample<service_status_t>();
  status.service = "map_server";
  status.state = "running";
  status.detail = "24060 points";
  Send(channels_.status, status);
  status.service = "window_optimizer";
  status.n_counters = 2;
  status.counter_name = {"overload.level", "KEYFRAME.queued"};
  status.counter_value = {2, 3};
  Send(channels_.status, status);
  procman_lcm::deputy_info_t info{};
  info.deputy_id = "host";
  info.ncmds = 1;
  info.cmds.resize(1);
  info.cmds[0].cmd.command_id = "window_optimizer";
  info.cmds[0].pid = 17;
  const std::vector<std::uint8_t> bytes = procman::EncodeProcman(info);
  bus_->Publish(procman::kPmInfo, bytes.data(), bytes.size());
  bus_->Poll(0);
  const std::string text = screen_.Draw(100, 24, false);
  EXPECT_THAT(text, HasSubstr("LOST  coasted too long"));
  EXPECT_THAT(text, HasSubstr("overload level 2 of 4"));
  EXPECT_THAT(text, HasSubstr("0 %      0 MB      3  "));
  EXPECT_THAT(text, HasSubstr("0.25    0.50    0.75 m"));
  EXPECT_THAT(text, HasSubstr("speed  1.50 m/s"));
  EXPECT_THAT(text, HasSubstr("24060 points"));
  EXPECT_THAT(text, HasSubstr("BODY_POSE"));
}

TEST_F(TopScreenTest, WhatIsNotKnownIsNoZero) {
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.mode = tracker_mode_t::BOOTSTRAPPING;
  Send(channels_.tracker_mode, mode);
  std::string text = screen_.Draw(100, 24, false);
  EXPECT_THAT(text, HasSubstr("position -"));
  EXPECT_THAT(text, HasSubstr("sigma -   points -"));
  mode.mode = tracker_mode_t::TRACKING;
  Send(channels_.tracker_mode, mode);
  window_state_t window = Sample<window_state_t>();
  window.n_points = 0;  // coasting
  window.inlier_share = 0;
  Send(channels_.window_state, window);
  EXPECT_THAT(screen_.Draw(100, 24, false), HasSubstr("points -"));
}

TEST_F(TopScreenTest, SaysThatARunHasEnded) {
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.mode = tracker_mode_t::TRACKING;
  Send(channels_.tracker_mode, mode);
  service_status_t status = Sample<service_status_t>();
  for (const char* name : {"map_server", "window_optimizer"}) {
    status.service = name;
    status.state = "running";
    Send(channels_.status, status);
  }
  status.service = "log_replay";  // done before the others
  status.state = "finished";
  Send(channels_.status, status);
  EXPECT_THAT(screen_.Draw(100, 24, false), Not(HasSubstr("ENDED")));
  for (const char* name : {"map_server", "window_optimizer"}) {
    status.service = name;
    ++status.epoch;
    Send(channels_.status, status);
  }
  EXPECT_THAT(screen_.Draw(100, 24, false),
              HasSubstr("ENDED  its services have finished; the last was: TRACKING"));
}

// Two deputies with the same commands, as of two pipelines with different prefixes on one bus.
TEST_F(TopScreenTest, OtherPipelinesOnTheBusAreTold) {
  service_status_t status = Sample<service_status_t>();
  status.service = "window_optimizer";
  Send(channels_.status, status);
  for (const char* deputy : {"evit", "evitother/"}) {
    procman_lcm::deputy_info_t info{};
    info.deputy_id = deputy;
    info.ncmds = 1;
    info.cmds.resize(1);
    info.cmds[0].cmd.command_id = "window_optimizer";
    info.cmds[0].pid = 17;
    info.cmds[0].mem_rss_bytes = deputy == std::string("evit") ? 10 << 20 : 70 << 20;
    const std::vector<std::uint8_t> bytes = procman::EncodeProcman(info);
    bus_->Publish(procman::kPmInfo, bytes.data(), bytes.size());
    bus_->Poll(0);
  }
  const std::string text = screen_.Draw(100, 24, false);
  EXPECT_THAT(text, HasSubstr("more pipelines on this bus (evitother/)"));
  EXPECT_THAT(text, HasSubstr("    10 MB"));
  EXPECT_THAT(text, Not(HasSubstr("    70 MB")));
}

TEST_F(TopScreenTest, FitsTheScreen) {
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.reason = std::string(500, 'x');
  Send(channels_.tracker_mode, mode);
  std::istringstream text(screen_.Draw(40, 3, false));
  int lines = 0;
  for (std::string line; std::getline(text, line); ++lines) EXPECT_LE(line.size(), 40U);
  EXPECT_EQ(lines, 3);
}

TEST_F(TopScreenTest, TextFromTheBusDoesNotSteerTheTerminal) {
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.reason = "\x1b]0;evil\x07";
  Send(channels_.tracker_mode, mode);
  EXPECT_THAT(screen_.Draw(80, 24, false), Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace evit::monitor
