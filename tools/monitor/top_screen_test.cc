#include "tools/monitor/top_screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

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
  const std::string text = screen_.Draw(100, 24, false);
  EXPECT_THAT(text, HasSubstr("LOST  coasted too long"));
  EXPECT_THAT(text, HasSubstr("0.25    0.50    0.75 m"));
  EXPECT_THAT(text, HasSubstr("speed  1.50 m/s"));
  EXPECT_THAT(text, HasSubstr("24060 points"));
  EXPECT_THAT(text, HasSubstr("BODY_POSE"));
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
