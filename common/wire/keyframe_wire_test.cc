#include "common/wire/keyframe_wire.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"
#include "common/wire/imu_wire.h"

namespace evit {
namespace {

std::vector<ImuSample> SomeSamples() {
  return {{1'000, {0.1, -0.2, 0.3}, {1, 2, 9.8}}, {6'000, {0.2, 0, 0}, {0, -1, 9.7}}};
}

void ExpectSame(const std::vector<ImuSample>& a, const std::vector<ImuSample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].t, b[i].t);
    EXPECT_EQ(a[i].gyro, b[i].gyro);
    EXPECT_EQ(a[i].accel, b[i].accel);
  }
}

template <typename Message>
Message Sent(const Message& message) {
  std::vector<std::uint8_t> bytes;
  EncodeTo(message, &bytes);
  Message out;
  std::string why;
  EXPECT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &out, &why)) << why;
  return out;
}

TEST(KeyframeWire, AKeyframeArrivesWithAllItHolds) {
  Keyframe k;
  k.utime = 6'000;
  k.seq = 12;
  k.previous_utime = 1'000;
  k.high_rate = true;
  k.n_events = 5'000'000'000;
  k.decay_us = 12'000.5;
  k.lookahead = 700;
  k.from_utime = 5'000;
  k.width = 3, k.height = 2;
  k.encoding = Keyframe::Encoding::kEventCount;
  k.surface = {1, 2, 3, 4, 5, 255};
  k.imu = SomeSamples();
  k.imu_gap = 5'000;
  const keyframe_t m = Sent(ToMessage(k));
  EXPECT_EQ(m.utime, 6'000);
  EXPECT_EQ(m.seq, 12);
  EXPECT_EQ(m.previous_utime, 1'000);
  EXPECT_EQ(m.high_rate, 1);
  EXPECT_EQ(m.n_events, 2'147'483'647);  // all an int32_t holds
  EXPECT_EQ(m.decay_us, 12'000.5);
  EXPECT_EQ(m.lookahead_us, 700);
  EXPECT_EQ(m.from_utime, 5'000);
  EXPECT_EQ(m.encoding, keyframe_t::EVENT_COUNT);
  EXPECT_EQ(m.surface, k.surface);
  EXPECT_EQ(m.imu_gap_us, 5'000);
  ExpectSame(SamplesOf(m), SomeSamples());
}

TEST(KeyframeWire, FeedbackIsWhatTheTrackerSays) {
  tracker_mode_t m{};
  m.mode = tracker_mode_t::LOST;
  m.image_speed = 120;
  m.keyframe_stride = 2;
  const TrackerFeedback f = ToFeedback(m);
  EXPECT_EQ(f.mode, TrackerFeedback::Mode::kLost);
  EXPECT_EQ(f.image_speed, 120);
  EXPECT_EQ(f.keyframe_stride, 2);
}

TEST(ImuWire, ASampleComesBackAsItWas) {
  const ImuSample sample = SomeSamples()[0];
  ExpectSame(SamplesOf(Sent(ToMessage(sample))), {sample});
}

}  // namespace
}  // namespace evit
