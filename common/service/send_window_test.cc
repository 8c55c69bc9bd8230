#include "common/service/send_window.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

constexpr std::int64_t kEpoch = 77;

credit_t Credit(const std::string& consumer, std::int64_t events, std::int64_t imu,
                std::int64_t stream_epoch = kEpoch, std::int64_t epoch = 1) {
  credit_t credit{};
  credit.epoch = epoch;
  credit.consumer = consumer;
  credit.stream_epoch = stream_epoch;
  credit.next_events_seq = events;
  credit.next_imu_seq = imu;
  return credit;
}

class SendWindowTest : public ::testing::Test {
 protected:
  SendWindowTest() : window_({"a", "b"}, 1000, 200) { window_.Restart(kEpoch); }
  void SendEvents(int n, std::int64_t bytes, std::int64_t now = 0) {
    for (int i = 0; i < n; ++i, ++events_) {
      window_.Sent({SendWindow::kEvents, events_, bytes, static_cast<std::size_t>(100 + events_)}, now);
    }
  }
  SendWindow window_;
  std::int64_t events_ = 0;
};

TEST_F(SendWindowTest, WaitsForAllConsumersToBeHeard) {
  EXPECT_EQ(window_.missing_consumers(), (std::vector<std::string>{"a", "b"}));
  window_.OnCredit(Credit("b", 0, 0, -1), 0);
  EXPECT_EQ(window_.missing_consumers(), std::vector<std::string>{"a"});
  EXPECT_EQ(window_.OnCredit(Credit("stranger", 0, 0), 0), SendWindow::Verdict::kNotAwaited);
  window_.OnCredit(Credit("a", 0, 0, -1), 5);
  EXPECT_TRUE(window_.missing_consumers().empty());
  EXPECT_EQ(window_.longest_silence(10), 10);
}

TEST_F(SendWindowTest, TheSlowestConsumerSetsTheBound) {
  SendEvents(2, 400);
  EXPECT_TRUE(window_.MaySend(200));
  EXPECT_FALSE(window_.MaySend(201));
  window_.OnCredit(Credit("a", 2, 0), 0);
  EXPECT_FALSE(window_.MaySend(201));
  EXPECT_FALSE(window_.all_acknowledged());
  window_.OnCredit(Credit("b", 1, 0), 0);
  EXPECT_EQ(window_.bytes_under_way(), 400);
  EXPECT_TRUE(window_.MaySend(600));
  EXPECT_EQ(window_.first_unacknowledged(0), 101U);
  window_.OnCredit(Credit("b", 2, 0), 0);
  EXPECT_TRUE(window_.all_acknowledged());
  EXPECT_EQ(window_.first_unacknowledged(9), 9U);
}

TEST_F(SendWindowTest, OneMessageLargerThanTheWindowMayGo) {
  EXPECT_TRUE(window_.MaySend(5000));
  SendEvents(1, 5000);
  EXPECT_FALSE(window_.MaySend(1));
}

TEST_F(SendWindowTest, StreamsAreAcknowledgedApartAndMinusOneMeansNotConsumed) {
  SendEvents(1, 10);
  window_.Sent({SendWindow::kImu, 0, 10, 200}, 0);
  window_.OnCredit(Credit("a", 1, -1), 0);
  window_.OnCredit(Credit("b", 0, 1), 0);
  EXPECT_FALSE(window_.all_acknowledged());
  window_.OnCredit(Credit("b", 1, 1), 0);
  EXPECT_TRUE(window_.all_acknowledged());
}

TEST_F(SendWindowTest, ImpossibleStaleAndOvertakenCreditsChangeNothing) {
  SendEvents(3, 10);
  EXPECT_EQ(window_.OnCredit(Credit("a", 4, 0), 0), SendWindow::Verdict::kImpossible);
  EXPECT_EQ(window_.OnCredit(Credit("a", 0, 1), 0), SendWindow::Verdict::kImpossible);
  window_.OnCredit(Credit("a", 3, 0, kEpoch - 1), 0);
  window_.OnCredit(Credit("b", 3, 0), 0);
  window_.OnCredit(Credit("b", 1, 0), 0);  // overtaken by the one before
  EXPECT_EQ(window_.bytes_under_way(), 30);
  window_.OnCredit(Credit("a", 3, 0), 0);
  EXPECT_TRUE(window_.all_acknowledged());
}

TEST_F(SendWindowTest, GoesBackAfterTheTimeoutWithOneMessageAsProbe) {
  SendEvents(3, 100, 1000);
  EXPECT_FALSE(window_.Stalled(1199));
  EXPECT_EQ(window_.NextAgain(), nullptr);
  EXPECT_TRUE(window_.Stalled(1200));
  window_.GoBack(1200);
  ASSERT_NE(window_.NextAgain(), nullptr);
  EXPECT_EQ(window_.NextAgain()->seq, 0);
  EXPECT_TRUE(window_.MaySend(100));
  window_.SentAgain();
  EXPECT_EQ(window_.NextAgain()->seq, 1);
  EXPECT_FALSE(window_.MaySend(100));  // only the probe until something moves
  window_.OnCredit(Credit("a", 1, 0), 1250);
  window_.OnCredit(Credit("b", 1, 0), 1250);
  EXPECT_TRUE(window_.MaySend(100));
  window_.SentAgain();
  window_.SentAgain();
  EXPECT_EQ(window_.NextAgain(), nullptr);
  EXPECT_EQ(window_.bytes_under_way(), 200);
}

TEST_F(SendWindowTest, AConsumerThatWasOnlySlowNeedsNothingAgain) {
  SendEvents(3, 100);
  ASSERT_TRUE(window_.Stalled(200));
  window_.GoBack(200);
  window_.OnCredit(Credit("a", 3, 0), 210);
  window_.OnCredit(Credit("b", 3, 0), 210);
  EXPECT_EQ(window_.NextAgain(), nullptr);
  EXPECT_EQ(window_.bytes_under_way(), 0);
  EXPECT_TRUE(window_.MaySend(1000));
}

TEST_F(SendWindowTest, PatienceDoublesUpToASecondUntilSomethingMoves) {
  SendWindow window({"a"}, 1000, 200'000);
  window.Restart(kEpoch);
  window.Sent({SendWindow::kEvents, 0, 100, 0}, 0);
  window.Sent({SendWindow::kEvents, 1, 100, 1}, 0);
  std::int64_t now = 0;
  for (const std::int64_t patience : {200'000, 400'000, 800'000, 1'000'000, 1'000'000}) {
    EXPECT_FALSE(window.Stalled(now + patience - 1));
    now += patience;
    EXPECT_TRUE(window.Stalled(now));
    window.GoBack(now);
    window.SentAgain();
  }
  window.OnCredit(Credit("a", 1, 0), now);
  window.SentAgain();
  EXPECT_TRUE(window.Stalled(now + 200'000));
}

TEST_F(SendWindowTest, ARestartedConsumerIsNoticed) {
  SendEvents(3, 100);
  EXPECT_EQ(window_.OnCredit(Credit("a", 0, 0, -1, 1), 0), SendWindow::Verdict::kTaken);
  EXPECT_EQ(window_.OnCredit(Credit("a", 0, 0, -1, 2), 0), SendWindow::Verdict::kTaken);  // had nothing yet
  EXPECT_EQ(window_.OnCredit(Credit("a", 2, 0, kEpoch, 2), 0), SendWindow::Verdict::kTaken);
  EXPECT_EQ(window_.OnCredit(Credit("a", 0, 0, -1, 3), 0), SendWindow::Verdict::kRestarted);
  window_.Restart(kEpoch + 1);
  EXPECT_EQ(window_.OnCredit(Credit("a", 0, 0, kEpoch + 1, 3), 0), SendWindow::Verdict::kTaken);
  EXPECT_TRUE(window_.all_acknowledged());
}

/// A lossy channel and a consumer that takes exactly the next message: everything arrives once, in order.
TEST_F(SendWindowTest, EverythingArrivesWhateverIsLost) {
  for (const int every : {2, 3, 7, 1000}) {
    SendWindow window({"a"}, 1000, 200);
    window.Restart(kEpoch);
    const int n = 500;
    std::int64_t next_sent = 0, next_expected = 0, now = 0;
    int transmissions = 0;
    const auto transmit = [&](std::int64_t seq) {
      const bool lost = ++transmissions % every == 0;
      if (!lost && seq == next_expected) ++next_expected;
    };
    while (next_expected < n || !window.all_acknowledged()) {
      now += 10;
      ASSERT_LT(now, 10'000'000) << "stuck with every " << every << "th lost";
      if (window.Stalled(now)) window.GoBack(now);
      for (const auto* again = window.NextAgain(); again != nullptr && window.MaySend(100);
           again = window.NextAgain()) {
        transmit(again->seq);
        window.SentAgain();
      }
      while (window.NextAgain() == nullptr && next_sent < n && window.MaySend(100)) {
        transmit(next_sent);
        window.Sent({SendWindow::kEvents, next_sent++, 100, 0}, now);
      }
      ASSERT_LE(window.bytes_under_way(), 1000);
      if (now % 50 == 0) window.OnCredit(Credit("a", next_expected, 0), now);
    }
  }
}

}  // namespace
}  // namespace evit
