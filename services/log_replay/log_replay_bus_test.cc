// The real program over real UDP multicast, in a network namespace of the test's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "common/bus/lcm_bus.h"
#include "common/service/credit_sender.h"
#include "common/service/sequence_counter.h"
#include "common/time/milliseconds.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/child_process.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/replay_recording.h"

namespace evit {
namespace {

using Clock = std::chrono::steady_clock;
const std::string kProgram = test::ProgramPath("log_replay");
constexpr std::chrono::seconds kPatience(60);  // nothing takes so long unless it fails
constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// A consumer as lossless replay expects it: takes exactly the next message of each stream, drops all else.
class Consumer {
 public:
  Consumer()
      : bus_(OpenLcmBus(kUrl)),
        reporter_(bus_.get(), Channels("test/"), "c", 1),
        credit_(bus_.get(), Channels(), "c", 1) {
    Take<event_packet_t>(Channels().events, &events_counter_, &events);
    Take<imu_batch_t>(Channels().imu, &imu_counter_, &imu);
    test::Keep(bus_.get(), Channels().stream_end, &ends);
    test::Keep(bus_.get(), Channels().status, &statuses);
  }

  /// Polls until `holds` or the time is over.
  template <typename Condition>
  bool PollUntil(const Condition& holds, std::chrono::milliseconds longest = kPatience) {
    const auto end = Clock::now() + longest;
    while (!holds()) {
      if (Clock::now() > end) return false;
      bus_->Poll(5);
      if (send_credit) credit_.Tick();
    }
    return true;
  }
  bool complete() const {
    return !ends.empty() && ends.back().epoch == epoch_ &&
           ends.back().n_events_messages == next(events_counter_) &&
           ends.back().n_imu_messages == next(imu_counter_);
  }
  void Order(int command, std::int64_t seek_utime = 0) {
    replay_control_t order{};
    order.epoch = 1;
    order.seq = orders_++;
    order.command = static_cast<std::int8_t>(command);
    order.seek_utime = seek_utime;
    test::Publish(bus_.get(), Channels().replay_control, order);
  }
  Bus* bus() { return bus_.get(); }
  bool HasState(const std::string& state) const {
    return !statuses.empty() && statuses.back().state == state;
  }

  std::vector<event_packet_t> events;
  std::vector<imu_batch_t> imu;
  std::vector<Clock::time_point> arrivals;  // of events
  std::vector<stream_end_t> ends;
  std::vector<service_status_t> statuses;
  bool send_credit = true;
  int drop_every = 0;
  int dropped = 0;
  std::chrono::microseconds work{0};  // per message

 private:
  static std::int64_t next(const SequenceCounter& counter) { return counter.next(); }

  template <typename Message>
  void Take(const std::string& channel, SequenceCounter* counter, std::vector<Message>* to) {
    bus_->Subscribe(channel, [=](const std::string&, const std::uint8_t* data, std::size_t size) {
      if (drop_every > 0 && ++heard_ % drop_every == 0) {
        ++dropped;
        return;
      }
      Message message;
      std::string why;
      ASSERT_TRUE(DecodeChecked(data, size, &message, &why)) << why;
      if (message.epoch != epoch_) {
        epoch_ = message.epoch;
        events_counter_ = SequenceCounter(&reporter_, "EVENTS");
        imu_counter_ = SequenceCounter(&reporter_, "IMU");
      }
      if (message.seq != counter->next()) {
        credit_.Ask();
        return;
      }
      counter->Commit(message.epoch, message.seq);
      if (to == reinterpret_cast<void*>(&events)) arrivals.push_back(Clock::now());
      to->push_back(message);
      if (work.count() > 0) std::this_thread::sleep_for(work);
      credit_.Consumed(epoch_, events_counter_.next(), imu_counter_.next(), size);
      if (!send_credit) return;
      credit_.Tick();
    });
  }

  std::unique_ptr<Bus> bus_;
  StatusReporter reporter_;
  CreditSender credit_;
  SequenceCounter events_counter_{&reporter_, "EVENTS"}, imu_counter_{&reporter_, "IMU"};
  std::int64_t epoch_ = -1;
  std::int64_t orders_ = 0;
  int heard_ = 0;
};

class LogReplayBusTest : public ::testing::Test {
 protected:
  LogReplayBusTest() : log_(::testing::TempDir() + "log_replay_bus_test.lcmlog") {}
  ~LogReplayBusTest() override { std::filesystem::remove(log_); }

  std::unique_ptr<ChildProcess> Start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {kProgram, "--log", log_, "--lcm-url", kUrl});
    return std::make_unique<ChildProcess>(arguments, log_ + ".stderr");
  }
  static void ExpectEverythingOnceInOrder(const Consumer& consumer, int packets) {
    ASSERT_EQ(consumer.events.size(), static_cast<std::size_t>(packets));
    ASSERT_EQ(consumer.imu.size(), static_cast<std::size_t>(2 * packets));
    for (int p = 0; p < packets; ++p) {
      EXPECT_EQ(consumer.events[p].seq, p);
      EXPECT_EQ(consumer.events[p].utime, 5'000'000 + p * 10'000);
      EXPECT_EQ(consumer.imu[2 * p + 1].utime, 5'005'000 + p * 10'000);
    }
  }
  std::string log_;
};

TEST_F(LogReplayBusTest, LosesNothingHoweverSlowTheConsumer) {
  TestRecording recording;
  recording.events_per_packet = 7000;  // 6 MB: several windows
  WriteTestRecording(log_, recording);
  Consumer consumer;
  consumer.work = std::chrono::milliseconds(3);
  const auto replay = Start({"--lossless", "--wait-for", "c", "--exit-at-end"});
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.complete(); }));
  ExpectEverythingOnceInOrder(consumer, recording.packets);
  consumer.PollUntil([&] { return consumer.HasState("finished"); });
  EXPECT_EQ(replay->Wait(kPatience), 0);
  EXPECT_EQ(replay->Stderr().find("error"), std::string::npos) << replay->Stderr();
}

TEST_F(LogReplayBusTest, SendsAgainWhatGotLost) {
  TestRecording recording;
  recording.packets = 20;
  WriteTestRecording(log_, recording);
  Consumer consumer;
  consumer.drop_every = 7;
  const auto replay = Start({"--lossless", "--wait-for", "c"});
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.complete(); }));
  EXPECT_GE(consumer.dropped, 60 / 7);
  ExpectEverythingOnceInOrder(consumer, recording.packets);
}

TEST_F(LogReplayBusTest, WaitsForAConsumerThatComesLate) {
  WriteTestRecording(log_, {});
  Consumer consumer;
  consumer.send_credit = false;
  const auto replay = Start({"--lossless", "--wait-for", "c"});
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.HasState("waiting"); }));
  EXPECT_TRUE(consumer.events.empty());
  EXPECT_NE(consumer.statuses.back().detail.find("from c:"), std::string::npos);
  EXPECT_GT(consumer.statuses.back().granted_receive_buffer, 0);
  consumer.send_credit = true;
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.complete(); }));
  ExpectEverythingOnceInOrder(consumer, 100);
}

TEST_F(LogReplayBusTest, KeepsTimeInRealTime) {
  TestRecording recording;
  recording.packets = 300;
  WriteTestRecording(log_, recording);
  Consumer consumer;
  consumer.send_credit = false;
  const auto replay = Start({});
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.events.size() == 300; }));
  std::vector<double> late_ms;
  for (std::size_t i = 0; i < 300; ++i) {
    late_ms.push_back(Milliseconds(consumer.arrivals[i] - consumer.arrivals[0]) -
                      10.0 * static_cast<double>(i));
  }
  // However busy the host, one in a hundred comes in time; a pace wrong by a tenth would show as 200 ms.
  const double early = *std::min_element(late_ms.begin(), late_ms.begin() + 100);
  const double late = *std::min_element(late_ms.end() - 100, late_ms.end());
  std::printf("arrival against data time, ms: %.3f at first, %.3f at last\n", early, late);
  EXPECT_NEAR(late, early, 150.0);
  // STREAM_END continues.
  EXPECT_TRUE(consumer.PollUntil([&] { return consumer.ends.size() >= 3; }));
}

TEST_F(LogReplayBusTest, ObeysPauseAndSeekAndIgnoresForgeries) {
  TestRecording recording;
  recording.packets = 3000;  // 30 s: does not end by itself
  WriteTestRecording(log_, recording);
  Consumer consumer;
  consumer.send_credit = false;
  const auto replay = Start({});
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.events.size() >= 10; }));
  for (const char* channel : {"REPLAY_CONTROL", "CREDIT"}) {
    const std::vector<std::uint8_t> junk(300, 0xFF);
    consumer.bus()->Publish(channel, junk.data(), junk.size());
  }
  consumer.Order(77);
  consumer.Order(replay_control_t::PAUSE);
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.HasState("paused"); }));
  consumer.PollUntil([] { return false; }, std::chrono::milliseconds(50));
  const std::size_t some = consumer.events.size();
  consumer.PollUntil([] { return false; }, std::chrono::milliseconds(200));
  EXPECT_EQ(consumer.events.size(), some);
  consumer.Order(replay_control_t::SEEK, 25'000'000);
  consumer.Order(replay_control_t::RESUME);
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.events.size() > some; }));
  EXPECT_EQ(consumer.events[some].utime, 25'000'000);
  EXPECT_EQ(consumer.events[some].seq, 0);
  EXPECT_NE(consumer.events[some].epoch, consumer.events[some - 1].epoch);
  replay->Signal(SIGTERM);
  ASSERT_TRUE(consumer.PollUntil([&] { return consumer.HasState("finished"); }));
  EXPECT_EQ(replay->Wait(kPatience), 0);
  EXPECT_EQ(replay->Stderr().find("error"), std::string::npos) << replay->Stderr();
  const service_status_t& last = consumer.statuses.back();
  const auto invalid =
      std::find(last.counter_name.begin(), last.counter_name.end(), "REPLAY_CONTROL.invalid");
  ASSERT_NE(invalid, last.counter_name.end());
  EXPECT_EQ(last.counter_value[static_cast<std::size_t>(invalid - last.counter_name.begin())], 2);
}

TEST_F(LogReplayBusTest, BadInputEndsItWithAClearMessage) {
  const auto expect = [this](const std::vector<std::string>& arguments, const std::string& words) {
    const auto replay = Start(arguments);
    const int code = replay->Wait(kPatience);
    EXPECT_GT(code, 0) << words;
    EXPECT_NE(replay->Stderr().find(words), std::string::npos) << replay->Stderr();
  };
  expect({}, "cannot open log " + log_);
  std::ofstream(log_).close();
  expect({}, "is empty");
  std::ofstream(log_) << std::string(1000, 'x');
  expect({}, "no whole LCM message");
  WriteTestRecording(log_, {});
  expect({"--seconds", "5"}, "A:B");
  expect({"--seconds", "500:600"}, "nothing to replay");
  expect({"--speed", "0"}, "--lossless");
  expect({"--no-such-option"}, "--no-such-option");
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) - 5);
  expect({}, "cut off");
}

}  // namespace
}  // namespace evit
