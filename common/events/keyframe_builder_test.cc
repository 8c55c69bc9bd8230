#include "common/events/keyframe_builder.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/helpers/event_streams.h"

namespace evit {
namespace {

using test::ImuStream;
using test::RandomStream;
using test::Slice;
using test::SmallOptions;
using test::SmallRig;
using Mode = TrackerFeedback::Mode;

TrackerFeedback Tracking(double speed) {
  TrackerFeedback f;
  f.mode = Mode::kTracking;
  f.image_speed = speed;
  return f;
}

/// A tracker that bootstraps for 5 keyframes, then tracks with changing figures, and is lost for a while.
TrackerFeedback Script(const Keyframe& k) {
  if (k.seq < 5) return {};
  TrackerFeedback f = Tracking(200 + 50.0 * (k.seq % 7));
  if (k.seq >= 20 && k.seq < 24) f.mode = Mode::kLost;
  return f;
}

/// Feeds both streams cut and interleaved at random; feedback comes with a random delay.
std::vector<Keyframe> BuildAll(const EventArray& events, const std::vector<ImuSample>& imu, unsigned seed,
                               std::size_t max_packet, bool without_imu = false) {
  KeyframeBuilder::Options options = SmallOptions();
  options.without_imu = without_imu;
  KeyframeBuilder builder(SmallRig(), options, true);
  std::mt19937 random(seed);
  std::vector<Keyframe> out;
  std::size_t e = 0, m = 0, answered = 0;
  const auto take = [&] {
    while (auto k = builder.Next()) out.push_back(std::move(*k));
    if (random() % 2 == 0) return;
    for (; answered < out.size(); ++answered)
      builder.SetFeedbackFor(out[answered].seq, Script(out[answered]));
    while (auto k = builder.Next()) out.push_back(std::move(*k));
  };
  while (e < events.size() || m < imu.size()) {
    if (m >= imu.size() || (e < events.size() && random() % 2 == 0)) {
      const std::size_t end = std::min(e + 1 + random() % max_packet, events.size());
      builder.AddEvents(Slice(events, e, end), events.t[end - 1]);
      e = end;
      if (random() % 4 == 0 && e < events.size()) builder.AddEvents({}, events.t[e]);  // a watermark
    } else {
      for (std::size_t n = 1 + random() % 8; n > 0 && m < imu.size(); --n) builder.AddImu(imu[m++]);
    }
    take();
  }
  builder.Flush();
  for (int i = 0; i < 1000; ++i) take();
  EXPECT_EQ(builder.counters().events_late, 0);
  return out;
}

void ExpectSame(const std::vector<Keyframe>& a, const std::vector<Keyframe>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].utime, b[i].utime) << i;
    ASSERT_EQ(a[i].seq, b[i].seq);
    ASSERT_EQ(a[i].n_events, b[i].n_events);
    ASSERT_EQ(a[i].decay_us, b[i].decay_us);
    ASSERT_EQ(a[i].surface, b[i].surface);
    ASSERT_EQ(a[i].imu.size(), b[i].imu.size());
  }
}

TEST(KeyframeBuilder, KeyframesDoNotDependOnPacketsAndInterleaving) {
  const EventArray events = RandomStream(1'000'000, 2'000'000, 60'000, 3);
  const std::vector<ImuSample> imu = ImuStream(1'001'000, 1'995'000);
  const std::vector<Keyframe> whole = BuildAll(events, imu, 1, events.size());
  ASSERT_GT(whole.size(), 30u);
  EXPECT_LT(whole.size(), 60u);
  ExpectSame(whole, BuildAll(events, imu, 2, 1));
  ExpectSame(whole, BuildAll(events, imu, 3, 50));
  ExpectSame(whole, BuildAll(events, imu, 4, 3'000));
}

TEST(KeyframeBuilder, WithoutAnImuKeyframesComeByTheEventsOwnClock) {
  const EventArray events = RandomStream(1'000'000, 3'000'000, 30'000, 3);
  EXPECT_TRUE(BuildAll(events, {}, 1, 1000).empty());
  const std::vector<Keyframe> whole = BuildAll(events, {}, 1, events.size(), true);
  ASSERT_GT(whole.size(), 30U);
  EXPECT_EQ(whole[0].utime, events.t[0] + 7'300);  // from the first event on, though it waits for an IMU
  EXPECT_EQ(whole[1].utime - whole[0].utime, 7'300);
  EXPECT_GT(whole.back().utime, events.t.back() - 60'000);
  EXPECT_LE(whole.back().utime, events.t.back());
  for (const Keyframe& k : whole) EXPECT_TRUE(k.imu.empty());
  for (const unsigned seed : {2, 3, 4}) ExpectSame(whole, BuildAll(events, {}, seed, 3000, true));
}

TEST(KeyframeBuilder, WithAnImuTheEventsOwnClockIsNotUsed) {
  const EventArray events = RandomStream(1'000'000, 3'000'000, 30'000, 3);
  const std::vector<ImuSample> imu = ImuStream(1'101'000, 2'995'000);
  const std::vector<Keyframe> with = BuildAll(events, imu, 1, 300, false);
  ASSERT_GT(with.size(), 30U);
  ExpectSame(with, BuildAll(events, imu, 1, 300, true));
}

TEST(KeyframeBuilder, WhereNoImuIsWaitedForTheEventsOwnClockBeginsAtOnce) {
  KeyframeBuilder::Options options = SmallOptions();
  options.without_imu = true;
  options.imu_patience = 0;
  KeyframeBuilder builder(SmallRig(), options, /*lossless=*/true);
  for (const ImuSample& sample : ImuStream(900'000, 1'100'000)) builder.AddImu(sample);  // does not count
  const EventArray events = RandomStream(1'000'000, 1'200'000, 30'000, 3);
  builder.AddEvents(events, events.t.back());
  const auto first = builder.Next();
  ASSERT_TRUE(first);
  EXPECT_LT(first->utime, events.t[0] + 100'000);
  EXPECT_TRUE(first->imu.empty());
}

TEST(KeyframeBuilder, LiveTheEventsOwnClockMakesUpForNothing) {
  KeyframeBuilder::Options options = SmallOptions();
  options.without_imu = true;
  KeyframeBuilder builder(SmallRig(), options, /*lossless=*/false);
  const EventArray events = RandomStream(1'000'000, 3'000'000, 30'000, 3);
  std::vector<Keyframe> keyframes;
  for (std::size_t k = 0; k < events.size(); k += 100) {
    builder.AddEvents(Slice(events, k, k + 100), events.t[k + 99]);
    while (auto keyframe = builder.Next()) keyframes.push_back(std::move(*keyframe));
  }
  ASSERT_GT(keyframes.size(), 100U);
  EXPECT_EQ(keyframes[0].utime, events.t[0] + EventClock::kPatience + 7'300);
  EXPECT_GT(keyframes[0].n_events, 100);
}

TEST(KeyframeBuilder, TheEventsOwnClockRestsWhereThereAreNone) {
  EventArray events = RandomStream(1'000'000, 2'000'000, 30'000, 3);
  const EventArray later = RandomStream(7'000'000, 8'000'000, 30'000, 4);
  for (std::size_t k = 0; k < later.size(); ++k)
    events.push_back(later.t[k], later.x[k], later.y[k], later.p[k]);
  const std::vector<Keyframe> whole = BuildAll(events, {}, 1, 5000, true);
  int between = 0;
  for (const Keyframe& k : whole) {
    between += k.utime > 3'100'000 && k.utime < 7'000'000;
    EXPECT_LT(k.utime - k.previous_utime, 200'000);
  }
  EXPECT_EQ(between, 0);
  EXPECT_GT(whole.back().utime, 7'900'000);
  for (const unsigned seed : {2, 3}) ExpectSame(whole, BuildAll(events, {}, seed, 700, true));
}

TEST(KeyframeBuilder, IntervalsJoinAndCarryTheirImuSamples) {
  const std::vector<Keyframe> all =
      BuildAll(RandomStream(1'000'000, 2'000'000, 60'000, 3), ImuStream(1'001'000, 1'995'000), 1, 500);
  int high_rate = 0, adaptive = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Keyframe& k = all[i];
    EXPECT_EQ(k.seq, static_cast<std::int64_t>(i));
    (k.high_rate ? high_rate : adaptive) += 1;
    if (i == 0) {
      EXPECT_EQ(k.previous_utime, k.utime);
      EXPECT_TRUE(k.imu.empty());
      continue;
    }
    EXPECT_EQ(k.previous_utime, all[i - 1].utime);
    ASSERT_GE(k.imu.size(), 2u);
    EXPECT_EQ(k.imu.front().t, k.previous_utime);
    EXPECT_EQ(k.imu.back().t, k.utime);
    EXPECT_EQ(k.imu_gap, 5'000);
    for (const ImuSample& s : k.imu) {  // the stream is smooth: interpolated samples are close to the truth
      EXPECT_NEAR(s.gyro.x(), 0.3 * std::sin(5 * ToSeconds(s.t)), 1e-3);
    }
    if (k.high_rate) {
      EXPECT_EQ(k.utime - k.previous_utime, 7'300);
    } else {
      EXPECT_EQ((k.utime - 1'001'000) % 5'000, 0);
      EXPECT_TRUE(k.n_events >= 1500 || k.utime - k.previous_utime >= 60'000);
    }
  }
  EXPECT_EQ(high_rate, 7 + 4);  // feedback acts two keyframes later
  EXPECT_GT(adaptive, 20);
  EXPECT_EQ(all[10].decay_us, 3e6 / (200 + 50.0 * (8 % 7)));  // tail / speed after keyframe 8
}

TEST(KeyframeBuilder, WaitsForTheFeedbackOfTheKeyframeBeforeTheLast) {
  KeyframeBuilder builder(SmallRig(), SmallOptions(), true);
  const EventArray events = RandomStream(0, 300'000, 60'000, 3);
  builder.AddEvents(events, events.t.back());
  for (const ImuSample& s : ImuStream(0, 290'000)) builder.AddImu(s);
  ASSERT_TRUE(builder.Next() && builder.Next());
  EXPECT_FALSE(builder.Next());
  EXPECT_EQ(builder.awaited_feedback(), 0);
  builder.SetFeedbackFor(1, Tracking(100));  // not the one
  EXPECT_FALSE(builder.Next());
  builder.SetFeedbackFor(0, {});
  EXPECT_TRUE(builder.Next());
  EXPECT_TRUE(builder.Next());  // by the feedback of 1
  EXPECT_FALSE(builder.Next());
  EXPECT_EQ(builder.awaited_feedback(), 2);
  EXPECT_EQ(builder.next_seq(), 4);
}

TEST(KeyframeBuilder, BadDataIsCountedAndDropped) {
  const EventArray events = RandomStream(1'000'000, 1'500'000, 40'000, 3);
  const std::vector<ImuSample> imu = ImuStream(1'000'000, 1'495'000);
  const auto run = [&](bool bad) {
    KeyframeBuilder builder(SmallRig(), SmallOptions(), false);
    std::vector<Keyframe> out;
    std::size_t m = 0;
    for (std::size_t e = 0; e < events.size(); e += 200) {
      builder.AddEvents(Slice(events, e, e + 200), events.t[e + 199]);
      if (bad) {
        EventArray wrong;
        wrong.push_back(events.t[e + 199] - 500'000, 1, 1, 1);
        builder.AddEvents(wrong, wrong.t[0]);
        wrong = {};
        wrong.push_back(events.t[e + 199], test::kWidth, 1, 1);
        builder.AddEvents(wrong, wrong.t[0]);
      }
      for (; m < imu.size() && imu[m].t <= events.t[e + 199]; ++m) {
        builder.AddImu(imu[m]);
        if (!bad) continue;
        ImuSample wrong = imu[m];
        builder.AddImu(wrong);
        wrong.t -= 2'000;
        builder.AddImu(wrong);
        wrong.t += 4'000;
        wrong.accel.y() = std::numeric_limits<double>::quiet_NaN();
        builder.AddImu(wrong);
      }
      while (auto k = builder.Next()) {
        builder.SetFeedbackFor(k->seq, Tracking(150));
        out.push_back(std::move(*k));
      }
    }
    EXPECT_EQ(builder.counters().events_late, bad ? 100 : 0);
    EXPECT_EQ(builder.counters().events_outside, bad ? 100 : 0);
    EXPECT_EQ(builder.counters().imu_late, bad ? 2 * static_cast<std::int64_t>(m) : 0);
    EXPECT_EQ(builder.counters().imu_invalid, bad ? static_cast<std::int64_t>(m) : 0);
    return out;
  };
  const std::vector<Keyframe> good = run(false);
  ASSERT_GT(good.size(), 8u);
  ExpectSame(good, run(true));
}

TEST(KeyframeBuilder, AClockSetBackRestartsTheStreams) {
  KeyframeBuilder builder(SmallRig(), SmallOptions(), false);
  builder.SetFeedbackFor(-1, Tracking(150));
  std::int64_t seq = -1;
  for (const Utime origin : {100'000'000, 5'000'000}) {
    const EventArray events = RandomStream(origin, origin + 300'000, 60'000, 3);
    for (const ImuSample& s : ImuStream(origin, origin + 20'000)) builder.AddImu(s);
    builder.AddEvents(events, events.t.back());
    for (const ImuSample& s : ImuStream(origin + 25'000, origin + 295'000)) builder.AddImu(s);
    bool first = true;
    int n = 0;
    for (; auto k = builder.Next(); ++n) {
      EXPECT_EQ(k->seq, ++seq);
      EXPECT_GE(k->utime, origin);
      EXPECT_LE(k->utime, origin + 300'000);
      EXPECT_EQ(k->previous_utime == k->utime, first);
      first = false;
    }
    EXPECT_GT(n, 5);
  }
  EXPECT_GE(builder.counters().resets, 1);
}

TEST(KeyframeBuilder, RealTimeContinuesWithoutEventsThatAreLate) {
  KeyframeBuilder builder(SmallRig(), SmallOptions(), false);
  const EventArray events = RandomStream(0, 100'000, 40'000, 3);
  builder.AddEvents(events, events.t.back());
  int n = 0;
  for (const ImuSample& s : ImuStream(0, 500'000)) {
    builder.AddImu(s);
    while (builder.Next()) ++n;  // high rate: no feedback
  }
  EXPECT_NEAR(n, 440 / 7.3, 4);  // up to 50 ms (and the look-ahead) before the newest IMU sample
}

}  // namespace
}  // namespace evit
