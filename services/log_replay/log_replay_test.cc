// LogReplay on the bus in memory: nothing is lost there, so what arrives is exactly what was sent.
#include <stdexcept>
#include <thread>

#include "tests/helpers/log_replay_fixture.h"

namespace evit {
namespace {

TEST_F(LogReplayTest, WaitsForItsConsumerThenSendsEverythingAndSaysSo) {
  Start();
  for (int i = 0; i < 3; ++i) Step(false);
  EXPECT_TRUE(events_.empty());
  ASSERT_FALSE(status_.empty());
  EXPECT_EQ(status_.back().state, "waiting");
  EXPECT_NE(status_.back().detail.find("from c:"), std::string::npos);
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  ASSERT_EQ(events_.size(), 100U);
  EXPECT_EQ(imu_.size(), 200U);
  EXPECT_EQ(truth_.size(), 100U);
  for (std::size_t i = 0; i < events_.size(); ++i) {
    EXPECT_EQ(events_[i].seq, static_cast<std::int64_t>(i));  // not the log's own 1000 + i
    EXPECT_EQ(events_[i].epoch, events_[0].epoch);
    EXPECT_EQ(events_[i].x[0], static_cast<int>(i));
  }
  ASSERT_FALSE(end_.empty());
  EXPECT_EQ(end_[0].epoch, events_[0].epoch);
  EXPECT_EQ(end_[0].n_events_messages, 100);
  EXPECT_EQ(end_[0].n_imu_messages, 200);
  EXPECT_EQ(end_[0].utime, 5'999'800);  // the last event
  StepUntil([&] { return status_.back().state == "finished"; });
  EXPECT_EQ(status_.back().state, "finished");
  EXPECT_EQ(status_.back().progress, 1.0);
}

TEST_F(LogReplayTest, NeverHasMoreThanItsWindowUnderWay) {
  TestRecording large;
  large.events_per_packet = 7000;
  Start(large);
  Step();
  for (int i = 0; i < 20; ++i) Step(false);
  EXPECT_EQ(events_.size(), (1U << 20) / (63'036 + 512 + 2 * (36 + 56 + 512)));
  Step();
  Step();
  EXPECT_GT(events_.size(), 17U);
}

TEST_F(LogReplayTest, DropsAndCountsWhatIsBrokenOrGoesBackInTime) {
  TestRecording bad;
  bad.backwards_packet = 40;
  bad.broken_packet = 60;
  Start(bad);
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  ASSERT_EQ(events_.size(), 98U);
  EXPECT_EQ(events_.back().seq, 97);  // no gap on the wire
  EXPECT_EQ(Counter("EVENTS.out_of_order"), 1);
  EXPECT_EQ(Counter("EVENTS.invalid"), 1);
  EXPECT_EQ(Counter("EVENTS.sent"), 98);
}

TEST_F(LogReplayTest, ReplaysThePartAskedFor) {
  options_.seconds = {0.2, 0.5};
  Start();
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  ASSERT_EQ(events_.size(), 30U);
  EXPECT_EQ(events_[0].utime, 5'200'000);
  EXPECT_EQ(events_[0].seq, 0);
}

TEST_F(LogReplayTest, SeeksWithANewEpoch) {
  Start();
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  const std::int64_t epoch = events_.back().epoch;
  Order(replay_control_t::SEEK, 5'900'000);
  events_.clear();
  imu_.clear();
  end_.clear();
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  ASSERT_EQ(events_.size(), 10U);
  EXPECT_NE(events_[0].epoch, epoch);
  EXPECT_EQ(events_[0].seq, 0);
  EXPECT_EQ(events_[0].utime, 5'900'000);
  EXPECT_EQ(end_[0].n_events_messages, 10);
}

TEST_F(LogReplayTest, PausesAndGoesOn) {
  options_.start_paused = true;
  Start();
  for (int i = 0; i < 5; ++i) Step();
  EXPECT_TRUE(events_.empty());
  EXPECT_EQ(status_.back().state, "paused");
  Order(replay_control_t::RESUME);
  Step();
  const std::size_t some = events_.size();
  EXPECT_GT(some, 0U);
  Order(replay_control_t::PAUSE);
  for (int i = 0; i < 5; ++i) Step();
  EXPECT_EQ(events_.size(), some);
  Order(replay_control_t::RESUME);
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  EXPECT_EQ(events_.size(), 100U);
}

TEST_F(LogReplayTest, ForgedControlAndCreditAreCountedAndIgnored) {
  Start();
  Step();
  const std::size_t some = events_.size();
  bus_->Publish(channels_.replay_control, "junk", 4);
  bus_->Publish(channels_.credit, "junk", 4);
  Order(9);
  Order(replay_control_t::SPEED, 0, -5);
  credit_t forged{};
  forged.consumer = "c";
  forged.stream_epoch = events_[0].epoch;
  forged.next_events_seq = 1'000'000;
  test::Publish(bus_.get(), channels_.credit, forged);
  forged.consumer = "stranger";
  test::Publish(bus_.get(), channels_.credit, forged);
  order_seq_ = 0;
  replay_bus_->Poll(0);
  EXPECT_EQ(Counter("REPLAY_CONTROL.invalid"), 3);
  EXPECT_EQ(Counter("CREDIT.invalid"), 2);
  EXPECT_EQ(Counter("CREDIT.not_awaited"), 1);
  for (int i = 0; i < 100 && end_.empty(); ++i) Step();
  EXPECT_GT(some, 0U);
  EXPECT_EQ(events_.size(), 100U);
}

TEST_F(LogReplayTest, ARestartedConsumerGetsANewStreamFromWhatWasNotConsumed) {
  TestRecording large;
  large.events_per_packet = 7000;
  Start(large);
  Step();
  Step();
  const std::size_t first = events_.size();
  ASSERT_GT(first, 10U);
  ASSERT_LT(first, 100U);
  Step(false);
  credit_t newcomer{};
  newcomer.epoch = 2;
  newcomer.consumer = "c";
  newcomer.stream_epoch = -1;
  const std::int64_t epoch = events_[0].epoch;
  test::Publish(bus_.get(), channels_.credit, newcomer);
  Step(false);
  EXPECT_EQ(Counter("CREDIT.restarts"), 1);
  ASSERT_GT(events_.size(), first);
  const event_packet_t& again = events_[first];
  EXPECT_NE(again.epoch, epoch);
  EXPECT_EQ(again.seq, 0);
  EXPECT_LE(again.utime, events_[first - 1].utime + 10'000);  // nothing is skipped
}

TEST_F(LogReplayTest, RealTimeNeedsNoConsumer) {
  options_.lossless = false;
  options_.speed = 100;
  TestRecording recording;
  recording.packets = 1000;
  Start(recording);
  const auto begin = std::chrono::steady_clock::now();
  StepUntil([&] { return !end_.empty(); });
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(events_.size(), 1000U);
  EXPECT_GT(took, 0.0990);  // 9.995 s of data, a hundred times as fast
  EXPECT_LT(took, 9.0);     // however busy the host
  Order(replay_control_t::SPEED, 0, 0);
  replay_bus_->Poll(0);
  EXPECT_EQ(Counter("REPLAY_CONTROL.refused"), 1);
}

TEST_F(LogReplayTest, ASuccessorGoesOnWithTheSameStream) {
  options_.lossless = false;
  options_.speed = 10;
  options_.position = path_ + ".position";
  std::filesystem::remove(options_.position);
  Start();
  StepUntil([&] { return events_.size() >= 30; });
  Start();  // as if killed: nobody called Stop()
  EXPECT_EQ(Counter("continued"), 1);
  StepUntil([&] { return !end_.empty(); });
  ASSERT_EQ(events_.size(), 100U);
  for (std::size_t k = 0; k < events_.size(); ++k) {
    EXPECT_EQ(events_[k].seq, static_cast<std::int64_t>(k));
    EXPECT_EQ(events_[k].epoch, events_[0].epoch);
  }
  EXPECT_EQ(imu_.size(), 200U);
  EXPECT_EQ(end_.back().n_events_messages, 100);

  Start();  // killed after the end: it still says so
  Step(false);
  EXPECT_EQ(end_.back().epoch, events_[0].epoch);
  replay_->Stop();
  Start();  // after a clean end: from the beginning
  EXPECT_EQ(Counter("continued"), 0);

  TestRecording other;
  other.packets = 50;
  Start(other);  // another recording: its position means nothing
  EXPECT_EQ(Counter("continued"), 0);
  std::filesystem::remove(options_.position);
}

TEST_F(LogReplayTest, OptionsThatDisagreeAreErrors) {
  options_.wait_for.clear();
  EXPECT_THROW(Start(), std::runtime_error);
  options_.lossless = false;
  options_.speed = 0;
  EXPECT_THROW(Start(), std::runtime_error);
  options_.speed = 1;
  options_.from_utime = 100'000'000;
  EXPECT_THROW(Start(), std::runtime_error);
  options_.from_utime.reset();
  options_.position = "/nonexistent/folder/position";
  EXPECT_THROW(Start(), std::runtime_error);
  options_.position.clear();
  options_.lossless = true;
  options_.wait_for = {"c"};
  options_.position = path_ + ".position";
  EXPECT_THROW(Start(), std::runtime_error);
}

}  // namespace
}  // namespace evit
