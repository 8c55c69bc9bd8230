// Over real UDP multicast, in a network namespace of the test's own.
#include "common/bus/lcm_bus.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/lcm_url.h"

namespace evit {
namespace {

constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0";

/// Polls until `done`, but for no more than a minute.
template <typename Done>
void PollUntil(Bus* bus, const Done& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!done() && std::chrono::steady_clock::now() < end) bus->Poll(10);
}

TEST(LcmBus, DeliversExactlyThisChannel) {
  const auto bus = OpenLcmBus(kUrl);
  const auto sender = OpenLcmBus(kUrl);
  std::vector<std::string> heard;
  const auto handler = [&](const std::string& channel, const std::uint8_t* data, std::size_t size) {
    heard.push_back(channel + ":" + std::string(data, data + size));
  };
  bus->Subscribe("a.b/C-1*", handler);
  bus->Subscribe("END", handler);
  for (const char* channel : {"aXb/C-1*", "a.b/C-1", "a.b/C-1**", "a.b/C-1*", "a.b/C-11", "END"}) {
    sender->Publish(channel, "x", 1);
  }
  PollUntil(bus.get(), [&] { return !heard.empty() && heard.back() == "END:x"; });
  EXPECT_EQ(heard, (std::vector<std::string>{"a.b/C-1*:x", "END:x"}));
}

TEST(LcmBus, OnePollHandsOutAllThatIsThere) {
  const auto bus = OpenLcmBus(kUrl);
  const auto sender = OpenLcmBus(kUrl);
  std::vector<int> heard;
  bus->Subscribe(
      "A", [&](const std::string&, const std::uint8_t* data, std::size_t) { heard.push_back(data[0]); });
  const int n = 200;  // far more than LCM's own queue of 30
  // LCM's thread takes them from the kernel in its own time: on a busy host it needs longer.
  int at_once = 0;
  for (auto wait = std::chrono::milliseconds(100); at_once < n && wait < std::chrono::seconds(30);
       wait *= 4) {
    heard.clear();
    for (int i = 0; i < n; ++i) {
      const auto byte = static_cast<std::uint8_t>(i);
      sender->Publish("A", &byte, 1);
    }
    std::this_thread::sleep_for(wait);
    at_once = bus->Poll(1000);
    PollUntil(bus.get(), [&] { return heard.size() >= static_cast<std::size_t>(n); });
  }
  EXPECT_EQ(at_once, n);
  ASSERT_EQ(heard.size(), static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) EXPECT_EQ(heard[i], i);
  EXPECT_EQ(bus->Poll(0), 0);
}

TEST(LcmBus, WhatWaitsIsBoundedAndDropsAreCounted) {
  const auto bus = OpenLcmBus(kUrl);
  const auto sender = OpenLcmBus(kUrl);
  const std::vector<std::uint8_t> message(60'000);
  const int n = 400;  // 24 MB: more than the 16 MiB that may wait for one subscription
  const int most = (16 << 20) / 60'000;
  int heard = 0, sent = 0, waited = 0;
  bus->Subscribe("A", [&](const std::string&, const std::uint8_t*, std::size_t) { ++heard; });
  // The kernel's buffer may lose some where LCM's thread is slow to empty it, on a busy host: then slower.
  for (auto pause = std::chrono::milliseconds(1); waited < most && pause < std::chrono::milliseconds(100);
       pause *= 4) {
    for (int i = 0; i < n; ++i, ++sent) {
      sender->Publish("A", message.data(), message.size());
      std::this_thread::sleep_for(pause);
    }
    std::this_thread::sleep_for(100 * pause);
    waited = bus->Poll(1000);
    while (bus->Poll(100) > 0) {
    }
  }
  EXPECT_EQ(waited, most);
  EXPECT_GT(bus->queue_drops(), 0);
  EXPECT_LE(heard + bus->queue_drops(), sent);
}

TEST(LcmBus, SaysWhatBufferTheKernelGranted) {
  EXPECT_EQ(OpenLcmBus("udpm://?ttl=0&recv_buf_size=65536")->granted_receive_buffer(), 65536);
  ::testing::internal::CaptureStderr();
  const auto greedy = OpenLcmBus("udpm://?ttl=0&recv_buf_size=1000000000");
  greedy->Subscribe("A", [](const std::string&, const std::uint8_t*, std::size_t) {});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(greedy->granted_receive_buffer(), ProbeReceiveBuffer(1'000'000'000));
  EXPECT_EQ(OpenLcmBus(kUrl)->granted_receive_buffer(), ProbeReceiveBuffer(4 << 20));
}

TEST(LcmBus, WhatCannotBeSentIsCounted) {
  ::testing::internal::CaptureStderr();
  const auto bus = OpenLcmBus(kUrl);
  EXPECT_EQ(bus->send_errors(), 0);
  const std::vector<std::uint8_t> huge(17 << 20);
  bus->Publish("A", huge.data(), huge.size());
  bus->Publish(std::string(64, 'x'), "x", 1);
  EXPECT_EQ(bus->send_errors(), 2);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(LcmBus, ALargeMessageArrivesWhole) {
  const auto bus = OpenLcmBus(kUrl);
  std::vector<std::uint8_t> message(std::size_t{640} * 480), heard;
  for (std::size_t i = 0; i < message.size(); ++i) message[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  bus->Subscribe("KEYFRAME", [&](const std::string&, const std::uint8_t* data, std::size_t size) {
    heard.assign(data, data + size);
  });
  for (int attempt = 0; attempt < 100 && heard.empty();
       ++attempt) {  // a small receive buffer may lose fragments
    bus->Publish("KEYFRAME", message.data(), message.size());
    bus->Poll(200);
  }
  EXPECT_EQ(heard, message);
}

TEST(LcmBus, WaitingCostsNoTimeOfTheProcessor) {
  const auto bus = OpenLcmBus(kUrl);
  bus->Subscribe("A", [](const std::string&, const std::uint8_t*, std::size_t) {});
  struct rusage before = {}, after = {};
  getrusage(RUSAGE_SELF, &before);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(bus->Poll(200), 0);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(190));
  getrusage(RUSAGE_SELF, &after);
  const auto microseconds = [](const timeval& t) { return 1'000'000 * t.tv_sec + t.tv_usec; };
  EXPECT_LT(microseconds(after.ru_utime) - microseconds(before.ru_utime), 50'000);
}

// Linux hands all groups of a port to every socket of it; another group would mix with ours.
TEST(LcmBus, AnotherGroupOnTheSamePortIsNotHeard) {
  const auto bus = OpenLcmBus("udpm://239.255.76.68:7667?ttl=0");
  const auto other = OpenLcmBus("udpm://239.255.76.69:7667?ttl=0");
  const auto own = OpenLcmBus("udpm://239.255.76.68:7667?ttl=0");
  std::vector<std::string> heard;
  bus->Subscribe("A", [&](const std::string&, const std::uint8_t* data, std::size_t size) {
    heard.emplace_back(data, data + size);
  });
  other->Publish("A", "foreign", 7);
  own->Publish("A", "own", 3);
  PollUntil(bus.get(), [&] { return !heard.empty() && heard.back() == "own"; });
  EXPECT_EQ(heard, std::vector<std::string>{"own"});
}

// A server that answers nothing: LCM's handshake waits for it, so only our own look at it is tested.
TEST(LcmBus, AServerThatIsNotThereIsAnErrorNotAnAbort) {
  EXPECT_THROW(OpenLcmBus("tcpq://127.0.0.1:7709"), std::runtime_error);
  EXPECT_THROW(OpenLcmBus("tcpq://127.0.0.1"), std::runtime_error);
  EXPECT_THROW(OpenLcmBus("tcpq://no.such.host.invalid:7700"), std::runtime_error);
}

TEST(LcmBus, WhatReachesNoOtherProcessIsRefused) {
  EXPECT_THROW(OpenLcmBus("memq://"), std::runtime_error);
  EXPECT_THROW(OpenLcmBus("file:///tmp/x.lcmlog?mode=w"), std::runtime_error);
}

TEST(LcmBus, ABadUrlIsAnError) {
  EXPECT_THROW(OpenLcmBus("nonsense://"), std::runtime_error);
  EXPECT_THROW(OpenLcmBus("udpm://10.0.0.1:7667"), std::runtime_error);
}

}  // namespace
}  // namespace evit
