// STATUS, sequence numbers, credit and the loop, on the bus in memory.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include "common/bus/memory_bus.h"
#include "common/service/credit_sender.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "tests/helpers/bus_messages.h"

namespace evit {
namespace {

class ServiceTest : public ::testing::Test {
 protected:
  ServiceTest() : bus_(OpenMemoryBus(MakeMemoryHub())) {
    test::Keep(bus_.get(), "p/STATUS", &status_);
    test::Keep(bus_.get(), "p/CREDIT", &credit_);
  }
  std::unique_ptr<Bus> bus_;
  Channels channels_{"p/"};
  std::vector<service_status_t> status_;
  std::vector<credit_t> credit_;
};

TEST_F(ServiceTest, StatusGoesOutOnChangeAndOnceASecond) {
  std::chrono::steady_clock::time_point now(std::chrono::seconds(100));
  StatusReporter reporter(bus_.get(), channels_, "map_server", 9, [&now] { return now; });
  reporter.Counter("EVENTS.lost") += 3;
  reporter.AddTiming("render", 1.0);
  reporter.AddTiming("render", 2.0);
  reporter.SetProgress(7);
  reporter.SetState("running", "x");
  reporter.SetState("running", "y");  // no change of state: waits for its second
  now += std::chrono::milliseconds(999);
  reporter.Tick();
  bus_->Poll(0);
  ASSERT_EQ(status_.size(), 1U);
  EXPECT_EQ(status_[0].service, "map_server");
  EXPECT_EQ(status_[0].epoch, 9);
  EXPECT_EQ(status_[0].detail, "x");
  EXPECT_EQ(status_[0].progress, 1.0);
  EXPECT_EQ(status_[0].counter_name[0], "EVENTS.lost");
  EXPECT_EQ(status_[0].counter_value[0], 3);
  EXPECT_EQ(status_[0].timing_ms, std::vector<double>{1.5});
  now += std::chrono::milliseconds(1);
  reporter.Tick();
  reporter.Tick();
  reporter.SetState("finished", "");
  bus_->Poll(0);
  ASSERT_EQ(status_.size(), 3U);
  EXPECT_EQ(status_[1].detail, "y");
  EXPECT_EQ(status_[2].seq, 2);
}

TEST_F(ServiceTest, TwoSendersOnOneChannelAreTold) {
  StatusReporter reporter(bus_.get(), channels_, "x", 1);
  SequenceCounter counter(&reporter, "EVENTS");
  counter.Commit(100, 0);
  counter.Commit(200, 0);  // a restart
  counter.Commit(200, 1);
  EXPECT_FALSE(counter.two_senders());
  for (int k = 0; k < 3; ++k) counter.Commit(100, 1 + k), counter.Commit(200, 2 + k);
  EXPECT_TRUE(counter.two_senders());
  EXPECT_GE(reporter.Counter("EVENTS.two_senders"), 3);
}

// A driver that never sets them: every message looks like the first again.
TEST_F(ServiceTest, MessagesWithoutNumbersAreAllTaken) {
  using Verdict = SequenceCounter::Verdict;
  StatusReporter reporter(bus_.get(), channels_, "x", 1);
  SequenceCounter counter(&reporter, "EVENTS");
  EXPECT_EQ(counter.Commit(0, 0), Verdict::kNewEpoch);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(counter.Commit(0, 0), Verdict::kNext);
  EXPECT_EQ(reporter.Counter("EVENTS.received"), 6);
  EXPECT_EQ(reporter.Counter("EVENTS.duplicate"), 0);
  EXPECT_EQ(reporter.Counter("EVENTS.unnumbered"), 5);
  // Of a sender that numbers its messages, the same is a repetition.
  SequenceCounter numbered(&reporter, "IMU");
  numbered.Commit(7, 0);
  EXPECT_EQ(numbered.Commit(7, 0), Verdict::kOld);
}

TEST_F(ServiceTest, SequenceCounterTellsGapsDuplicatesAndRestarts) {
  using Verdict = SequenceCounter::Verdict;
  StatusReporter reporter(bus_.get(), channels_, "x", 1);
  SequenceCounter counter(&reporter, "IMU");
  EXPECT_EQ(counter.Commit(5, 3), Verdict::kNewEpoch);  // joined late: nothing counts as lost
  EXPECT_EQ(counter.Classify(5, 4), Verdict::kNext);
  EXPECT_EQ(counter.Commit(5, 4), Verdict::kNext);
  EXPECT_EQ(counter.Commit(5, 4), Verdict::kOld);
  EXPECT_EQ(counter.Commit(5, 8), Verdict::kGap);
  EXPECT_EQ(counter.Commit(5, 6), Verdict::kOld);
  EXPECT_EQ(counter.next(), 9);
  EXPECT_EQ(counter.Commit(4, 0), Verdict::kNewEpoch);
  counter.CountInvalid();
  EXPECT_EQ(reporter.Counter("IMU.received"), 4);
  EXPECT_EQ(reporter.Counter("IMU.lost"), 3);
  EXPECT_EQ(reporter.Counter("IMU.duplicate"), 2);
  EXPECT_EQ(reporter.Counter("IMU.restarts"), 1);
  EXPECT_EQ(reporter.Counter("IMU.invalid"), 1);
}

TEST_F(ServiceTest, CreditGoesOutAtOnceForEachWindowfulAndOnRequest) {
  std::int64_t now_us = 0;
  CreditSender sender(bus_.get(), channels_, "frame_builder", 4, [&now_us] { return now_us; });
  sender.Tick();  // here I am
  sender.Tick();
  sender.Consumed(7, 1, 0, 120'000);  // a new stream
  sender.Tick();
  sender.Consumed(7, 2, 0, 160'000);
  sender.Consumed(7, 3, 0, 160'000);  // 256 kB and more
  sender.Ask();
  sender.Tick();
  now_us += CreditSender::kPeriodUs - 1;
  sender.Tick();
  now_us += 1;
  sender.Tick();
  bus_->Poll(0);
  ASSERT_EQ(credit_.size(), 5U);
  EXPECT_EQ(credit_[0].stream_epoch, -1);
  EXPECT_EQ(credit_[1].next_events_seq, 1);
  EXPECT_EQ(credit_[2].next_events_seq, 3);
  EXPECT_EQ(credit_[4].consumer, "frame_builder");
  EXPECT_EQ(credit_[4].seq, 4);
}

TEST(Epoch, IsNewEachTime) {
  const std::int64_t first = NewEpoch();
  EXPECT_GT(first, 0);
  EXPECT_GT(NewEpoch(), first);
}

class CountingService : public Service {
 public:
  explicit CountingService(int raise_at) : raise_at_(raise_at) {}
  void Tick() override {
    if (++ticks == raise_at_) raise(SIGTERM);
  }
  bool done() const override { return ticks >= 10; }
  void Stop() override { ++stops; }
  int ticks = 0, stops = 0;

 private:
  int raise_at_;
};

TEST_F(ServiceTest, RunsUntilDoneOrSignalled) {
  CountingService finishing(-1);
  EXPECT_EQ(RunService(&finishing, bus_.get()), 0);
  EXPECT_EQ(finishing.ticks, 10);
  EXPECT_EQ(finishing.stops, 1);
  CountingService signalled(3);
  EXPECT_EQ(RunService(&signalled, bus_.get()), 0);
  EXPECT_EQ(signalled.ticks, 3);
  EXPECT_EQ(signalled.stops, 1);
}

TEST(GuardedMain, TurnsAnExceptionIntoOneLine) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(GuardedMain(
                "prog", [](int, char**) -> int { throw std::runtime_error("no log"); }, 0, nullptr),
            1);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "prog: error: no log\n");
  EXPECT_EQ(GuardedMain(
                "prog", [](int, char**) { return 7; }, 0, nullptr),
            7);
}

TEST(ServiceOptions, UrlOfOptionThenEnvironmentThenDefault) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(ResolveLcmUrl("memq://"), "memq://");
  EXPECT_EQ(ResolveLcmUrl(""), "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304");
  setenv("LCM_DEFAULT_URL", "udpm://239.1.1.1:7000", 1);
  EXPECT_EQ(ResolveLcmUrl(""), "udpm://239.1.1.1:7000");
  unsetenv("LCM_DEFAULT_URL");
  CommandLine line("");
  ServiceOptions options;
  AddServiceOptions(&line, &options);
  const char* const arguments[] = {"prog", "--prefix", "a/", "--lossless", "--lcm-url", "memq://"};
  EXPECT_FALSE(line.Parse(6, arguments));
  EXPECT_EQ(options.prefix, "a/");
  EXPECT_TRUE(options.lossless);
  EXPECT_EQ(options.lcm_url, "memq://");
}

}  // namespace
}  // namespace evit
