#include "services/frame_builder/frame_builder.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "common/bus/memory_bus.h"
#include "tests/helpers/frame_builder_peers.h"

namespace evit {
namespace {

using test::MakeRecording;
using test::Publish;

class FrameBuilderTest : public ::testing::Test {
 protected:
  void Start(bool lossless) {
    FrameBuilder::Settings settings;
    settings.rig = test::SmallRig();
    settings.keyframes = test::SmallOptions();
    settings.lossless = lossless;
    settings.send_again = std::chrono::milliseconds(20);
    service_ = std::make_unique<FrameBuilder>(bus_.get(), Channels(), settings);
  }
  /// The bus runs until nothing moves.
  void Settle() {
    while (peer_bus_->Poll(0) + bus_->Poll(0) > 0) service_->Tick();
    service_->Tick();
    while (peer_bus_->Poll(0) > 0) {
    }
  }
  /// Whole recording, in pieces.
  void Replay(test::Sender* sender, unsigned seed) {
    std::mt19937 random(seed);
    while (sender->SendSome(1 + random() % 20)) Settle();
    Settle();
    sender->SendEnd();
    Settle();
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), peer_bus_ = OpenMemoryBus(hub_);
  std::unique_ptr<FrameBuilder> service_;
  test::Tracker tracker_{peer_bus_.get()};
};

void ExpectSame(const std::vector<keyframe_t>& a, const std::vector<keyframe_t>& b) {
  ASSERT_EQ(a.size(), b.size());
  std::vector<std::uint8_t> x, y;
  for (std::size_t i = 0; i < a.size(); ++i) {
    keyframe_t other = b[i];
    other.epoch = a[i].epoch;
    EncodeTo(a[i], &x);
    EncodeTo(other, &y);
    ASSERT_EQ(x, y) << "keyframe " << i;
  }
}

TEST_F(FrameBuilderTest, LosslessRunDrainsAndSaysSo) {
  Start(true);
  test::Sender sender(peer_bus_.get(), MakeRecording(300), 77);
  Replay(&sender, 1);
  ASSERT_GT(tracker_.keyframes.size(), 30u);
  EXPECT_EQ(tracker_.state, "drained");
  EXPECT_EQ(tracker_.counters["last_keyframe_seq"], tracker_.keyframes.back().seq);
  EXPECT_EQ(tracker_.counters["EVENTS.received"], 200);
  EXPECT_EQ(sender.credit.consumer, "frame_builder");
  EXPECT_EQ(sender.credit.stream_epoch, 77);
  EXPECT_EQ(sender.credit.next_events_seq, 200);
  EXPECT_EQ(sender.credit.next_imu_seq, 199);
  for (std::size_t i = 0; i < tracker_.keyframes.size(); ++i) {
    const keyframe_t& k = tracker_.keyframes[i];
    EXPECT_EQ(k.seq, static_cast<std::int64_t>(i));
    EXPECT_EQ(k.high_rate, i < 7 ? 1 : 0);  // mode of keyframe i-2
    if (i >= 7) {
      EXPECT_DOUBLE_EQ(k.decay_us, 3e6 / (200 + 50.0 * ((i - 2) % 7)));
    }
    if (i == 0) continue;
    EXPECT_EQ(k.imu_utime.front(), k.previous_utime);
    EXPECT_EQ(k.imu_utime.back(), k.utime);
  }
}

TEST_F(FrameBuilderTest, LosslessGivesTheSameKeyframesHoweverDataComes) {
  Start(true);
  test::Sender first(peer_bus_.get(), MakeRecording(300), 77);
  Replay(&first, 1);
  const std::vector<keyframe_t> expected = std::move(tracker_.keyframes);
  ASSERT_GT(expected.size(), 30u);

  // Other packets, keyframes that get lost, messages that come twice and out of order.
  hub_ = MakeMemoryHub();
  bus_ = OpenMemoryBus(hub_);
  peer_bus_ = OpenMemoryBus(hub_);
  test::Tracker tracker(peer_bus_.get());
  tracker.drop_every = 5;
  Start(true);
  test::Sender second(peer_bus_.get(), MakeRecording(37), 78);
  std::mt19937 random(5);
  for (int round = 0; tracker.state != "drained" && round < 3000; ++round) {
    if (!second.SendSome(1 + random() % 200)) second.SendEnd();
    Settle();
    if (random() % 3 == 0) second.GoBack();
    // Nothing moves before a lost keyframe is sent again.
    if (tracker.dropped > tracker.twice) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_GT(tracker.dropped, 5);
  EXPECT_GT(tracker.counters["EVENTS.duplicate"], 0);
  EXPECT_GT(tracker.counters["KEYFRAME.sent_again"], 0);
  ExpectSame(expected, tracker.keyframes);
}

TEST_F(FrameBuilderTest, MissingAnswerHoldsTheCreditBack) {
  Start(true);
  tracker_.answer_at_once = false;
  test::Sender sender(peer_bus_.get(), MakeRecording(300), 77);
  Replay(&sender, 1);
  EXPECT_EQ(tracker_.keyframes.size(), 2u);  // keyframe 2 needs the answer to 0
  EXPECT_EQ(tracker_.state, "running");
  EXPECT_LT(sender.credit.next_events_seq, 20);
  const std::int64_t held = sender.credit.next_events_seq;
  tracker_.Answer();
  Settle();
  EXPECT_EQ(tracker_.keyframes.size(), 4u);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));  // a credit is due
  Settle();
  EXPECT_GT(sender.credit.next_events_seq, held);
  tracker_.answer_at_once = true;
  tracker_.Answer();
  for (int i = 0; i < 100 && tracker_.state != "drained"; ++i) Settle();
  EXPECT_EQ(tracker_.state, "drained");
}

TEST_F(FrameBuilderTest, ASecondReplayRestartsTheStream) {
  Start(true);
  test::Sender first(peer_bus_.get(), MakeRecording(300, 300'000), 77);
  Replay(&first, 1);
  ASSERT_EQ(tracker_.state, "drained");
  const std::size_t before = tracker_.keyframes.size();
  test::Sender second(peer_bus_.get(), MakeRecording(300, 300'000), 78);
  Replay(&second, 2);
  ASSERT_EQ(tracker_.state, "drained");
  ASSERT_GT(tracker_.keyframes.size(), before + 5);
  const keyframe_t& k = tracker_.keyframes[before];
  EXPECT_EQ(k.previous_utime, k.utime);  // nothing of the first replay is left
  EXPECT_LT(k.utime, tracker_.keyframes[before - 1].utime);
  EXPECT_EQ(k.seq, static_cast<std::int64_t>(before));
}

TEST_F(FrameBuilderTest, RealTimeNeverWaitsAndCountsLosses) {
  Start(false);
  tracker_.answer_at_once = false;
  test::RecordedMessages recording = MakeRecording(300);
  recording.events.erase(recording.events.begin() + 50, recording.events.begin() + 60);
  test::Sender sender(peer_bus_.get(), recording, 77);
  Replay(&sender, 1);
  EXPECT_EQ(tracker_.state, "drained");
  EXPECT_EQ(tracker_.counters["EVENTS.lost"], 10);
  EXPECT_NEAR(static_cast<double>(tracker_.keyframes.size()), 994 / 7.3, 2);  // bootstrapping all the time
  EXPECT_EQ(tracker_.counters["KEYFRAME.sent_again"], 0);
}

TEST_F(FrameBuilderTest, ARestartedOptimiserGetsTheKeyframesSinceItsLastOneAndThenTheNewerOnes) {
  Start(false);
  test::Sender sender(peer_bus_.get(), MakeRecording(300), 77);
  while (tracker_.keyframes.size() < 20 && sender.SendSome(1)) Settle();
  ASSERT_GE(tracker_.keyframes.size(), 20U);
  EXPECT_EQ(tracker_.counters["KEYFRAME.sent_again"], 0);
  tracker_mode_t mode{};  // a new epoch that knows all but the last five
  mode.epoch = 1006;
  mode.keyframe_epoch = tracker_.keyframes[0].epoch;
  mode.keyframe_seq = tracker_.keyframes.back().seq - 5;
  mode.mode = tracker_mode_t::TRACKING;
  mode.keyframe_stride = 1;
  mode.resend = 1;
  tracker_.answer_at_once = false;
  std::vector<std::int64_t> heard;
  test::Listen<keyframe_t>(peer_bus_.get(), Channels().keyframe,
                           [&](const keyframe_t& keyframe) { heard.push_back(keyframe.seq); });
  const auto expect_since = [&](std::size_t least) {
    ASSERT_GE(heard.size(), least);
    for (std::size_t k = 0; k < heard.size(); ++k)
      EXPECT_EQ(heard[k], mode.keyframe_seq + 1 + static_cast<std::int64_t>(k));
  };
  for (int times = 0; times < 2; ++times) {  // it says so until it is heard
    heard.clear();
    mode.seq = times;
    Publish(peer_bus_.get(), Channels().tracker_mode, mode);
    for (int k = 0; k < 8; ++k) Settle();
    expect_since(5);
    EXPECT_EQ(heard.size(), 5U);
  }
  heard.clear();
  mode.seq = 2;
  Publish(peer_bus_.get(), Channels().tracker_mode, mode);
  sender.SendSome(400);  // keyframes are made before the old ones have been sent again
  for (int k = 0; k < 16; ++k) Settle();
  expect_since(7);
  heard.clear();
  mode.seq = 3;
  mode.resend = 0;  // it works again, and answers
  Publish(peer_bus_.get(), Channels().tracker_mode, mode);
  Settle();
  EXPECT_TRUE(heard.empty());
}

TEST_F(FrameBuilderTest, BadMessagesAreCountedAndChangeNothing) {
  Start(true);
  test::Sender sender(peer_bus_.get(), MakeRecording(300), 77);
  const std::vector<std::uint8_t> rubbish(100, 0x5A);
  std::mt19937 random(3);
  while (sender.SendSome(10)) {
    for (const std::string& channel :
         {Channels().events, Channels().imu, Channels().tracker_mode, Channels().stream_end}) {
      peer_bus_->Publish(channel, rubbish.data(), random() % rubbish.size());
    }
    tracker_mode_t forged{};
    forged.epoch = 6;
    forged.keyframe_seq = 1'000'000;
    forged.mode = tracker_mode_t::TRACKING;
    if (!tracker_.keyframes.empty()) forged.keyframe_epoch = tracker_.keyframes[0].epoch;
    Publish(peer_bus_.get(), Channels().tracker_mode, forged);
    Settle();
  }
  sender.SendEnd();
  Settle();
  EXPECT_EQ(tracker_.state, "drained");
  EXPECT_GT(tracker_.counters["EVENTS.invalid"], 10);
  EXPECT_GT(tracker_.counters["IMU.invalid"], 10);
  EXPECT_GT(tracker_.counters["TRACKER_MODE.invalid"], 10);
  EXPECT_GT(tracker_.counters["STREAM_END.invalid"], 10);
  const std::vector<keyframe_t> disturbed = std::move(tracker_.keyframes);

  hub_ = MakeMemoryHub();
  bus_ = OpenMemoryBus(hub_);
  peer_bus_ = OpenMemoryBus(hub_);
  test::Tracker tracker(peer_bus_.get());
  Start(true);
  test::Sender again(peer_bus_.get(), MakeRecording(300), 78);
  Replay(&again, 1);
  ExpectSame(tracker.keyframes, disturbed);
}

}  // namespace
}  // namespace evit
