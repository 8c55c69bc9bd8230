#include "common/events/active_event_surface.h"

#include <gtest/gtest.h>

#include "common/events/hot_pixels.h"

namespace evit {
namespace {

void Update(ActiveEventSurface* surface, const EventArray& e) {
  surface->Update(e.t.data(), e.x.data(), e.y.data(), e.size());
}

TEST(ActiveEventSurface, KeepsTheNewestOfEitherPolarityAndDropsWhatIsOutside) {
  ActiveEventSurface surface(4, 3);
  EventArray e;
  e.push_back(5'000'000'000, 1, 2, 1);
  e.push_back(5'000'000'010, 1, 2, 0);
  e.push_back(5'000'000'020, 2, 2, 1);
  e.push_back(5'000'000'030, 4, 0, 1);
  e.push_back(5'000'000'030, 0, 3, 1);
  e.push_back(5'000'000'030, 65'535, 65'535, 0);
  Update(&surface, e);
  EXPECT_EQ(surface.outside(), 3);
  EXPECT_EQ(surface.stamps()[2 * 4 + 1] + surface.base(), 5'000'000'010);
  EXPECT_EQ(surface.stamps()[2 * 4 + 2] + surface.base(), 5'000'000'020);
  EXPECT_EQ(surface.stamps()[0], ActiveEventSurface::kNever);
}

TEST(ActiveEventSurface, TimesRunOnForDays) {
  ActiveEventSurface surface(2, 1);
  EventArray e;
  for (int hour = 0; hour < 100; ++hour) e.push_back(hour * 3'600'000'000LL, hour == 0 ? 1 : 0, 0, 1);
  Update(&surface, e);
  const Utime now = 99 * 3'600'000'000LL + 1000;
  EXPECT_EQ(surface.Relative(now) - surface.stamps()[0], 1000);
  EXPECT_GT(surface.Relative(now) - surface.stamps()[1], 900'000'000);
  EXPECT_GT(surface.Relative(now + 1'000'000'000'000) - surface.stamps()[0], 0);
}

TEST(HotPixels, FindsTheOneThatFiresAloneAndForgivesABusyRegion) {
  HotPixels hot(20, 10, 100);
  EventArray e;
  for (Utime t = 0; t < 600'000; t += 1'000) {
    e.push_back(t, 3, 3, 1);                                                 // alone, 1 kHz
    for (int x = 10; x < 14; ++x) e.push_back(t, x, 4 + (t / 1000) % 2, 0);  // a busy region, 500 Hz each
    if (t % 20'000 == 0) e.push_back(t, 17, 8, 1);                           // alone, 50 Hz: too slow
  }
  hot.Update(e, 0, e.size());
  EXPECT_EQ(hot.pixels(), std::vector<std::int32_t>{3 * 20 + 3});
  hot.AdvanceTo(1'700'000);
  EXPECT_TRUE(hot.pixels().empty());
}

TEST(HotPixels, DoNotDependOnHowEventsAreCut) {
  EventArray e;
  for (Utime t = -700'000; t < 900'000; t += 500) e.push_back(t, t < 0 ? 1 : 5, 2, 1);
  HotPixels whole(20, 10, 100), pieces(20, 10, 100);
  whole.Update(e, 0, e.size());
  for (std::size_t i = 0; i < e.size(); i += 7) pieces.Update(e, i, std::min(i + 7, e.size()));
  EXPECT_EQ(whole.pixels(), std::vector<std::int32_t>{45});
  EXPECT_EQ(pieces.pixels(), whole.pixels());
}

}  // namespace
}  // namespace evit
