#include "common/events/surface_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "common/events/reference_surface.h"

namespace evit {
namespace {

constexpr int kWidth = 60, kHeight = 40;

SurfaceOptions Settings(bool support, double truncation, double sigma) {
  SurfaceOptions s;
  s.support_filter = support;
  s.truncation = truncation;
  s.blur_sigma_px = sigma;
  return s;
}

EventArray RandomEvents(int n, Utime begin, Utime end, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Utime> times(n);
  for (Utime& t : times) t = begin + static_cast<Utime>(random() % (end - begin));
  std::sort(times.begin(), times.end());
  EventArray events;
  for (const Utime t : times) {
    events.push_back(t, random() % kWidth, random() % kHeight, random() % 2);
  }
  return events;
}

struct Case {
  Utime lookahead;
  bool support;
  double truncation, sigma, decay;
};

class RenderTest : public testing::TestWithParam<Case> {};

TEST_P(RenderTest, WithinOneGreyLevelOfPlainReference) {
  const Case& c = GetParam();
  const EventArray events = RandomEvents(9000, 1'000'000, 1'100'000, 7);
  const Utime t = 1'080'000;
  const SurfaceOptions s = Settings(c.support, c.truncation, c.sigma);
  const std::size_t middle = std::upper_bound(events.t.begin(), events.t.end(), t) - events.t.begin();
  const std::size_t end =
      std::upper_bound(events.t.begin(), events.t.end(), t + c.lookahead) - events.t.begin();
  ActiveEventSurface surface(kWidth, kHeight);
  surface.Update(events.t.data(), events.x.data(), events.y.data(), middle);
  SurfaceRenderer renderer(kWidth, kHeight, s);
  SurfaceRenderer::View view;
  view.t = t;
  view.decay_us = c.decay;
  view.after = &events;
  view.begin = middle;
  view.end = end;
  const SurfaceRenderer::Image image = renderer.Render(surface, view);
  ReferenceSurface reference(kWidth, kHeight, s);
  reference.Update(events, 0, middle);
  const std::vector<double> expected = reference.Render(t, c.decay, events, middle, end);
  int dark = 0;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    ASSERT_NEAR(image[i], expected[i], 1.01) << "pixel " << i % kWidth << ", " << i / kWidth;
    dark += expected[i] < 220;
  }
  EXPECT_GT(dark, 5);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RenderTest,
                         testing::Values(Case{0, false, 20, 1, 15'000}, Case{10'000, false, 20, 1, 15'000},
                                         Case{10'000, true, 20, 1, 3'000}, Case{10'000, true, 0, 0, 30'000},
                                         Case{5'000, false, 60, 1.5, 2'000}));

/// Where the valley of a moving edge lies, minus where the edge is: mean over rows, pixels along the motion.
double Lag(double speed, Utime lookahead, double tail_px) {
  EventArray events;
  const Utime begin = 1'000'000, t = 1'200'000;
  const auto edge = [&](int y, double time) { return 30 + 0.37 * y + speed * (time - t) * 1e-6; };
  std::vector<std::array<double, 3>> list;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double time = t + (x - edge(y, t)) / speed * 1e6;
      if (time > begin && time < t + 200'000) list.push_back({time, double(x), double(y)});
    }
  }
  std::sort(list.begin(), list.end());
  for (const auto& e : list) events.push_back(std::llround(e[0]), e[1], e[2], 1);
  const std::size_t middle = std::upper_bound(events.t.begin(), events.t.end(), t) - events.t.begin();
  const std::size_t end =
      std::upper_bound(events.t.begin(), events.t.end(), t + lookahead) - events.t.begin();
  ActiveEventSurface surface(kWidth, kHeight);
  surface.Update(events.t.data(), events.x.data(), events.y.data(), middle);
  SurfaceRenderer renderer(kWidth, kHeight, Settings(true, 20, 1));
  SurfaceRenderer::View view;
  view.t = t;
  view.decay_us = std::clamp(tail_px / speed * 1e6, 2'000.0, 30'000.0);
  view.after = &events;
  view.begin = middle;
  view.end = end;
  const SurfaceRenderer::Image image = renderer.Render(surface, view);
  double sum = 0;
  for (int y = 3; y < 13; ++y) {
    const std::uint8_t* row = image.data() + std::ptrdiff_t{y} * kWidth;
    const int x = static_cast<int>(std::min_element(row + 2, row + kWidth - 2) - row);
    const double a = row[x - 1], b = row[x], c = row[x + 1];  // vertex of the parabola through three values
    sum += x + 0.5 * (a - c) / (a - 2 * b + c) - edge(y, t);
  }
  return sum / 10;
}

TEST(SymmetricSurface, ValleyLiesOnTheEdgeWhereTheCausalOneLags) {
  for (const double speed : {300.0, 600.0, 1200.0, 2500.0}) {
    const double symmetric = Lag(speed, 10'000, 3), causal = Lag(speed, 0, 3);
    std::printf("  %5.0f px/s: valley minus edge: symmetric %+.2f px, causal %+.2f px\n", speed, symmetric,
                causal);
    EXPECT_LT(std::abs(symmetric), 0.3) << speed;
    EXPECT_LT(causal, -0.5) << speed;
  }
  for (const double speed : {30.0, 100.0}) {
    std::printf("  %5.0f px/s: symmetric %+.2f px, causal %+.2f px\n", speed, Lag(speed, 10'000, 3),
                Lag(speed, 0, 3));
  }
}

TEST(SurfaceRenderer, IgnoredPixelsAndLoneEventsLeaveNoTrace) {
  ActiveEventSurface surface(kWidth, kHeight);
  EventArray events;
  events.push_back(1000, 10, 10, 1);  // alone
  events.push_back(1000, 30, 20, 1);  // a pair
  events.push_back(1000, 31, 20, 0);
  surface.Update(events.t.data(), events.x.data(), events.y.data(), events.size());
  SurfaceRenderer renderer(kWidth, kHeight, Settings(true, 20, 0));
  SurfaceRenderer::View view;
  view.t = 1000;
  view.decay_us = 10'000;
  SurfaceRenderer::Image image = renderer.Render(surface, view);
  EXPECT_EQ(image[10 * kWidth + 10], 255);
  EXPECT_EQ(image[20 * kWidth + 30], 0);
  EXPECT_EQ(image[20 * kWidth + 31], 0);
  const std::vector<std::int32_t> hot{20 * kWidth + 31};
  view.ignored = &hot;
  image = renderer.Render(surface, view);
  EXPECT_EQ(std::count(image.begin(), image.end(), 255),
            kWidth * kHeight);  // and with it its neighbour's support
}

}  // namespace
}  // namespace evit
