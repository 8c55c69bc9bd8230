#include "tools/monitor/monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/sample_messages.h"
#include "tests/helpers/web_client.h"

namespace evit::monitor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t kPixels = 640UL * 480;

// A monitor on a bus in memory, and clients on its port, all in one thread.
class MonitorTest : public ::testing::Test {
 protected:
  void Start(bool read_only = false) {
    MonitorOptions options;
    options.web.port = 0;
    options.read_only = read_only;
    monitor_ = std::make_unique<Monitor>(options);
    monitor_->Watch(bus_.get());
    host_ = "127.0.0.1:" + std::to_string(monitor_->port());
  }
  std::unique_ptr<test::WebClient> Connect(const std::string& origin, const std::string& protocol) {
    auto client = std::make_unique<test::WebClient>(monitor_->port());
    EXPECT_TRUE(client->connected());
    client->Upgrade(host_, origin, protocol);
    return client;
  }
  std::unique_ptr<test::WebClient> OpenPage() {
    auto client = Connect("http://" + host_, PageAudience::kProtocol);
    EXPECT_THAT(HeadOf(client.get()), HasSubstr("101 "));
    return client;
  }
  // Until it holds; false where it does not within seconds.
  template <typename Condition>
  bool Until(Condition condition) {
    for (int i = 0; i < 3000; ++i) {
      bus_->Poll(0);
      peer_->Poll(0);
      monitor_->Tick();
      if (condition()) return true;
      if (i > 50) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  // The head of the answer to a request; empty where the line was closed without one.
  std::string HeadOf(test::WebClient* client) {
    std::optional<std::string> head;
    Until([&] {
      client->Read();
      head = client->Head();
      return head || client->closed();
    });
    return head.value_or("");
  }
  // The next frame that contains `part`.
  std::string FrameWith(test::WebClient* client, const std::string& part) {
    std::string found;
    Until([&] {
      client->Read();
      for (auto frame = client->Frame(); frame; frame = client->Frame()) {
        if (frame->find(part) != std::string::npos) found = *frame;
      }
      return !found.empty();
    });
    return found;
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), peer_ = OpenMemoryBus(hub_);
  Channels channels_;
  std::unique_ptr<Monitor> monitor_;
  std::string host_;
};

TEST_F(MonitorTest, ItsOwnPageConnectsAndHearsOfThePipeline) {
  Start();
  const auto page = OpenPage();
  EXPECT_THAT(FrameWith(page.get(), "\"status\""), HasSubstr("\"services\""));
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.mode = tracker_mode_t::LOST;
  mode.reason = "coasted \xff too long";  // not UTF-8: the bus may hold anything
  test::Publish(peer_.get(), channels_.tracker_mode, mode);
  EXPECT_THAT(FrameWith(page.get(), "too long"), HasSubstr("\"lost\""));
}

TEST_F(MonitorTest, PagesFromElsewhereAndUnknownProtocolsAreRefused) {
  Start();
  for (const char* origin : {"http://evil.example", "null"}) {
    const auto client = Connect(origin, PageAudience::kProtocol);
    EXPECT_THAT(HeadOf(client.get()), Not(HasSubstr("101 "))) << origin;
    EXPECT_TRUE(Until([&] { return client->Read(), client->closed(); })) << origin;
  }
  for (const char* protocol : {"http", "unknown.v1"}) {
    const auto client = Connect("http://" + host_, protocol);
    EXPECT_THAT(HeadOf(client.get()), Not(HasSubstr("101 "))) << protocol;
  }
}

TEST_F(MonitorTest, FilesAreServedByNameAndNothingElse) {
  Start();
  const auto get = [&](const std::string& path, const std::string& host) {
    test::WebClient client(monitor_->port());
    client.SendRaw("GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    return HeadOf(&client);
  };
  EXPECT_THAT(get("/", host_), HasSubstr("200 OK"));
  EXPECT_THAT(get("/", host_), HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(get("/../../../etc/passwd", host_), Not(HasSubstr("200 OK")));
  EXPECT_THAT(get("/etc/passwd", host_), HasSubstr("404 "));
  EXPECT_THAT(get("/", "evil.example"), HasSubstr("403 "));
}

TEST_F(MonitorTest, AHintReachesTheBus) {
  Start();
  std::vector<body_pose_t> hints;
  test::Keep(peer_.get(), channels_.pose_hint, &hints);
  const auto page = OpenPage();
  page->SendText(R"({"order":"hint","position":[1,2,3],"orientation":[0,0,0,1]})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("\"ok\":true"));
  ASSERT_TRUE(Until([&] { return !hints.empty(); }));
  EXPECT_EQ(hints[0].position[2], 3);
}

TEST_F(MonitorTest, SeekingNeedsAReplayAndCountsFromItsBegin) {
  Start();
  std::vector<replay_control_t> controls;
  test::Keep(peer_.get(), channels_.replay_control, &controls);
  const auto page = OpenPage();
  page->SendText(R"({"order":"seek","share":0.5})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("no log_replay"));
  service_status_t status = Sample<service_status_t>();
  status.service = "log_replay";
  status.n_counters = 2;
  status.counter_name = {"recording.begin_utime", "recording.end_utime"};
  status.counter_value = {1'000'000, 3'000'000};
  test::Publish(peer_.get(), channels_.status, status);
  ASSERT_THAT(FrameWith(page.get(), "recording.begin_utime"), HasSubstr("log_replay"));
  page->SendText(R"({"order":"seek","share":0.5})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("1.00 s"));
  ASSERT_TRUE(Until([&] { return !controls.empty(); }));
  EXPECT_EQ(controls[0].command, replay_control_t::SEEK);
  EXPECT_EQ(controls[0].seek_utime, 2'000'000);
}

TEST_F(MonitorTest, AReplayThatIsSentBackTakesTheTrackerAlong) {
  Start();
  std::vector<body_pose_t> hints;
  test::Keep(peer_.get(), channels_.pose_hint, &hints);
  const auto page = OpenPage();
  service_status_t status = Sample<service_status_t>();
  status.service = "log_replay";
  status.n_counters = 2;
  status.counter_name = {"recording.begin_utime", "recording.end_utime"};
  status.counter_value = {1'000'000, 3'000'000};
  test::Publish(peer_.get(), channels_.status, status);
  ASSERT_THAT(FrameWith(page.get(), "recording.begin_utime"), HasSubstr("log_replay"));
  page->SendText(R"({"order":"seek","share":0})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("not known"));
  EXPECT_TRUE(hints.empty());

  monitor_->SetStart({Eigen::Quaterniond::Identity(), {1, 2, 3}});
  page->SendText(R"({"order":"seek","share":0})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("where the body was then"));
  ASSERT_TRUE(Until([&] { return hints.size() == 1; }));
  EXPECT_EQ(hints[0].position[2], 3);
  // One keyframe from before the jump, then the first at the place sought: the hint comes again, once.
  tracker_mode_t mode = Sample<tracker_mode_t>();
  mode.mode = tracker_mode_t::BOOTSTRAPPING;
  for (const std::int64_t utime : {2'900'000, 1'010'000, 1'020'000}) {
    mode.utime = utime;
    ++mode.seq;
    test::Publish(peer_.get(), channels_.tracker_mode, mode);
  }
  ASSERT_TRUE(Until([&] { return hints.size() == 2; }));
  EXPECT_EQ(hints[1].position[0], 1);
  EXPECT_GT(hints[1].seq, hints[0].seq);
}

TEST_F(MonitorTest, OnlyProcessesThatASupervisorNamedAreRestarted) {
  Start();
  const auto page = OpenPage();
  page->SendText(R"({"order":"restart","command":"rm"})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("\"ok\":false"));
  procman_lcm::deputy_info_t info{};
  info.deputy_id = "host";
  info.ncmds = 1;
  info.cmds.resize(1);
  info.cmds[0].cmd.command_id = "map_server";
  info.cmds[0].pid = 17;
  info.cmds[0].actual_runid = 4;
  std::vector<std::uint8_t> bytes = procman::EncodeProcman(info);
  peer_->Publish(procman::kPmInfo, bytes.data(), bytes.size());
  std::vector<procman_lcm::orders_t> orders;
  peer_->Subscribe(procman::kPmOrders, [&](const std::string&, const std::uint8_t* data, std::size_t size) {
    procman_lcm::orders_t message;
    ASSERT_TRUE(procman::DecodeProcman(data, size, &message));
    orders.push_back(message);
  });
  ASSERT_THAT(FrameWith(page.get(), "\"pid\":17"), HasSubstr("map_server"));
  page->SendText(R"({"order":"restart","command":"map_server"})");
  ASSERT_TRUE(Until([&] { return !orders.empty(); }));
  EXPECT_EQ(orders[0].deputy_id, "host");
  ASSERT_EQ(orders[0].cmds.size(), 1U);
  EXPECT_EQ(orders[0].cmds[0].desired_runid, 5);
  EXPECT_EQ(orders[0].cmds[0].force_quit, 0);
}

TEST_F(MonitorTest, ReadOnlyMeansThatNoOrderReachesTheBus) {
  Start(true);
  std::vector<body_pose_t> hints;
  test::Keep(peer_.get(), channels_.pose_hint, &hints);
  const auto page = OpenPage();
  page->SendText(R"({"order":"hint","position":[1,2,3],"orientation":[0,0,0,1]})");
  EXPECT_THAT(FrameWith(page.get(), "\"answer\""), HasSubstr("read-only"));
  peer_->Poll(0);
  EXPECT_TRUE(hints.empty());
}

TEST_F(MonitorTest, AMessageThatIsTooLongEndsTheLine) {
  Start();
  const auto page = OpenPage();
  page->SendText(std::string(70'000, ' '));
  EXPECT_TRUE(Until([&] { return page->Read(), page->closed(); }));
}

TEST_F(MonitorTest, AViewerThatReadsNothingDoesNotStopOthers) {
  Start();
  const auto stuck = Connect("http://" + host_, PageAudience::kProtocol);
  const auto page = OpenPage();
  keyframe_t keyframe = Sample<keyframe_t>();
  keyframe.width = 640;
  keyframe.height = 480;
  keyframe.surface_size = 640 * 480;
  keyframe.surface.assign(kPixels, 200);
  int pictures = 0;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(Until([&] {
    ++keyframe.seq;
    if (std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(35) * pictures) {
      test::Publish(peer_.get(), channels_.keyframe, keyframe);
    }
    page->Read();
    for (auto frame = page->Frame(); frame; frame = page->Frame()) {
      if (frame->size() < kPixels) continue;
      ++pictures;
      page->SendText(R"({"order":"drawn"})");
    }
    return pictures == 20;
  })) << pictures;
}

TEST_F(MonitorTest, APictureTakesFewLooks) {
  Start();
  const auto page = OpenPage();
  ASSERT_THAT(FrameWith(page.get(), "\"status\""), HasSubstr("services"));
  keyframe_t keyframe = Sample<keyframe_t>();
  keyframe.width = 640;
  keyframe.height = 480;
  keyframe.surface_size = 640 * 480;
  keyframe.surface.assign(kPixels, 200);
  test::Publish(peer_.get(), channels_.keyframe, keyframe);
  int looks = 0;
  bool come = false;
  ASSERT_TRUE(Until([&] {
    ++looks;
    page->Read();
    for (auto frame = page->Frame(); frame; frame = page->Frame()) come |= frame->size() > kPixels;
    return come;
  }));
  EXPECT_LT(looks, 40);  // not one for each 4 kB: between two of them the monitor may wait for the bus
}

}  // namespace
}  // namespace evit::monitor
