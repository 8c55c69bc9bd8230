#include "common/events/surface_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace evit {
namespace {

constexpr int kWidth = 60, kHeight = 40;

SurfaceOptions Settings(bool support, bool split, double truncation, double sigma) {
  SurfaceOptions s;
  s.support_filter = support;
  s.split_polarity = split;
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

/// Written as plainly as possible: double precision, no tables, from the list of events.
class Reference {
 public:
  Reference(const EventArray& events, Utime t, Utime lookahead, double decay, const SurfaceOptions& s)
      : events_(events), t_(t), lookahead_(lookahead), decay_(decay), s_(s) {}

  // Polarities as bits: 1 darker, 2 brighter.
  double Distance(int x, int y, int polarities) const {
    double best = 1e18;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if (events_.x[i] != x || events_.y[i] != y || (polarities & (1 << events_.p[i])) == 0) continue;
      if (events_.t[i] <= t_ + lookahead_) best = std::min(best, std::abs(double(events_.t[i] - t_)));
    }
    return best;
  }
  std::vector<double> Image(int polarities) const {
    std::vector<double> drawn(std::size_t{kWidth} * kHeight), rows = drawn, out = drawn;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double value = 255 * std::exp(-Distance(x, y, polarities) / decay_);
        drawn[y * kWidth + x] = value >= s_.truncation && (!s_.support_filter || Supported(x, y)) ? value : 0;
      }
    }
    Blur(drawn, &rows, true);
    Blur(rows, &out, false);
    for (double& v : out) v = 255 - v;
    return out;
  }

 private:
  bool Supported(int x, int y) const {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kHeight - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kWidth - 1); ++u) {
        if ((u != x || v != y) && Distance(u, v, 3) <= 2 * decay_) return true;
      }
    }
    return false;
  }
  void Blur(const std::vector<double>& in, std::vector<double>* out, bool along_x) const {
    const double sigma = s_.blur_sigma_px;
    const int radius = sigma > 0 ? static_cast<int>(std::lround(6 * sigma)) / 2 : 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double sum = 0, weights = 0;
        for (int k = -radius; k <= radius; ++k) {
          const auto mirror = [](int i, int n) { return i < 0 ? -i : i >= n ? 2 * n - 2 - i : i; };
          const int u = along_x ? mirror(x + k, kWidth) : x, v = along_x ? y : mirror(y + k, kHeight);
          const double w = radius > 0 ? std::exp(-0.5 * k * k / (sigma * sigma)) : 1;
          sum += w * in[v * kWidth + u];
          weights += w;
        }
        (*out)[y * kWidth + x] = sum / weights;
      }
    }
  }

  const EventArray& events_;
  Utime t_, lookahead_;
  double decay_;
  SurfaceOptions s_;
};

struct Case {
  Utime lookahead;
  bool support, split;
  double truncation, sigma, decay;
};

class RenderTest : public testing::TestWithParam<Case> {};

TEST_P(RenderTest, WithinOneGreyLevelOfPlainReference) {
  const Case& c = GetParam();
  const EventArray events = RandomEvents(9000, 1'000'000, 1'100'000, 7);
  const Utime t = 1'080'000;
  const SurfaceOptions s = Settings(c.support, c.split, c.truncation, c.sigma);
  const std::size_t middle = std::upper_bound(events.t.begin(), events.t.end(), t) - events.t.begin();
  const std::size_t end =
      std::upper_bound(events.t.begin(), events.t.end(), t + c.lookahead) - events.t.begin();
  ActiveEventSurface surface(kWidth, kHeight);
  surface.Update(events.t.data(), events.x.data(), events.y.data(), events.p.data(), middle);
  SurfaceRenderer renderer(kWidth, kHeight, s);
  SurfaceRenderer::View view;
  view.t = t;
  view.decay_us = c.decay;
  view.after = &events;
  view.begin = middle;
  view.end = end;
  const auto images = renderer.Render(surface, view);
  ASSERT_EQ(images.size(), c.split ? 2u : 1u);
  const Reference reference(events, t, c.lookahead, c.decay, s);
  for (std::size_t k = 0; k < images.size(); ++k) {
    const std::vector<double> expected = reference.Image(!c.split ? 3 : k == 0 ? 2 : 1);
    int dark = 0;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      ASSERT_NEAR(images[k][i], expected[i], 1.01) << "pixel " << i % kWidth << ", " << i / kWidth;
      dark += expected[i] < 220;
    }
    EXPECT_GT(dark, 5);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, RenderTest,
                         testing::Values(Case{0, false, false, 20, 1, 15'000},
                                         Case{10'000, false, false, 20, 1, 15'000},
                                         Case{10'000, true, false, 20, 1, 3'000},
                                         Case{10'000, true, true, 0, 0, 30'000},
                                         Case{5'000, false, true, 60, 1.5, 2'000}));

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
  surface.Update(events.t.data(), events.x.data(), events.y.data(), events.p.data(), middle);
  SurfaceRenderer renderer(kWidth, kHeight, Settings(true, false, 20, 1));
  SurfaceRenderer::View view;
  view.t = t;
  view.decay_us = std::clamp(tail_px / speed * 1e6, 2'000.0, 30'000.0);
  view.after = &events;
  view.begin = middle;
  view.end = end;
  const SurfaceRenderer::Image image = renderer.Render(surface, view)[0];
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
  surface.Update(events.t.data(), events.x.data(), events.y.data(), events.p.data(), events.size());
  SurfaceRenderer renderer(kWidth, kHeight, Settings(true, false, 20, 0));
  SurfaceRenderer::View view;
  view.t = 1000;
  view.decay_us = 10'000;
  SurfaceRenderer::Image image = renderer.Render(surface, view)[0];
  EXPECT_EQ(image[10 * kWidth + 10], 255);
  EXPECT_EQ(image[20 * kWidth + 30], 0);
  EXPECT_EQ(image[20 * kWidth + 31], 0);
  const std::vector<std::int32_t> hot{20 * kWidth + 31};
  view.ignored = &hot;
  image = renderer.Render(surface, view)[0];
  EXPECT_EQ(std::count(image.begin(), image.end(), 255),
            kWidth * kHeight);  // and with it its neighbour's support
}

}  // namespace
}  // namespace evit
