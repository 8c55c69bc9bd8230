#include "common/events/event_counter.h"

#include <gtest/gtest.h>

#include "common/events/keyframe_builder.h"
#include "tests/helpers/event_streams.h"

namespace evit {
namespace {

TEST(EventCounter, CountsWithSignLimitsAndIgnores) {
  EventArray events;
  events.push_back(1, 2, 1, 0);  // not in the interval
  for (int k = 0; k < 3; ++k) events.push_back(10 + k, 2, 1, 1);
  events.push_back(20, 2, 1, 0);
  events.push_back(21, 0, 0, 0);
  for (int k = 0; k < 300; ++k) events.push_back(30 + k, 3, 0, k < 280 ? 1 : 0);
  for (int k = 0; k < 200; ++k) events.push_back(400 + k, 1, 1, 0);
  events.push_back(700, 0, 1, 1);
  EventCounter counter(4, 2);
  for (int round = 0; round < 2; ++round) {  // nothing stays from one image to the next
    const EventCounter::Image image = counter.Count(events, 1, events.size(), {4});
    const EventCounter::Image expected{127, 128, 128, 255, 128, 1, 130, 128};
    EXPECT_EQ(image, expected);
  }
}

// As the builder cuts them: half of each interval before a keyframe's stamp, half after it.
TEST(EventCounter, KeyframesCountAroundTheirStamp) {
  KeyframeBuilder::Options options = test::SmallOptions();
  options.encoding = Keyframe::Encoding::kEventCount;
  options.surface.hot_pixel_rate_hz = 0;
  const EventArray all = test::RandomStream(1'000'000, 2'000'000, 60'000, 3);
  KeyframeBuilder builder(test::SmallRig(), options, true);
  for (const ImuSample& s : test::ImuStream(1'001'000, 1'990'000)) builder.AddImu(s);
  builder.AddEvents(all, all.t.back());
  builder.Flush();
  int n = 0;
  while (true) {
    auto k = builder.Next();
    if (!k) break;
    builder.SetFeedbackFor(k->seq, {});
    EXPECT_FALSE(k->high_rate);
    EXPECT_EQ(k->encoding, Keyframe::Encoding::kEventCount);
    if (k->seq > 0) {
      EXPECT_GE(k->n_events, 1500);  // adaptive from the start
      EXPECT_NEAR(static_cast<double>(k->utime - k->from_utime), 0.5 * (k->utime - k->previous_utime), 1);
      EXPECT_EQ(k->lookahead, std::min<Utime>(k->utime - k->from_utime, 10'000));
    }
    EventArray part;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all.t[i] > k->from_utime && all.t[i] <= k->utime + k->lookahead)
        part.push_back(all.t[i], all.x[i], all.y[i], all.p[i]);
    }
    EXPECT_EQ(k->surface, EventCounter(test::kWidth, test::kHeight).Count(part, 0, part.size(), {}));
    ++n;
  }
  EXPECT_GT(n, 20);
}

}  // namespace
}  // namespace evit
