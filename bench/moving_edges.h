#pragma once

#include <cmath>
#include <random>

#include "common/events/event.h"

namespace evit::bench {

/// Sorted events of some dozens of slanted edges that sweep over a VGA image, `n` of them at `rate` per
/// second: neighbours in time lie on the same edges, as in a recording.
inline EventArray MovingEdges(std::size_t n, double rate, unsigned seed = 1) {
  constexpr int kWidth = 640, kHeight = 480, kEdges = 48;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  struct Edge {
    float x, slope, speed;
    int top, length;
  };
  std::vector<Edge> edges;
  edges.reserve(kEdges);
  for (int k = 0; k < kEdges; ++k) {
    edges.push_back({kWidth * uniform(random), uniform(random) - 0.5F, 600 * (uniform(random) - 0.5F),
                     static_cast<int>(300 * uniform(random)), 60 + static_cast<int>(120 * uniform(random))});
  }
  EventArray events;
  for (std::size_t k = 0; k < n; ++k) {
    const double seconds = static_cast<double>(k) / rate;
    const Edge& e = edges[random() % kEdges];
    const int y = std::min(e.top + static_cast<int>(random() % static_cast<unsigned>(e.length)), kHeight - 1);
    float x = e.x + e.speed * static_cast<float>(seconds) + e.slope * static_cast<float>(y - e.top) +
              2 * uniform(random);
    x -= kWidth * std::floor(x / kWidth);
    events.push_back(1'000'000 + static_cast<Utime>(seconds * 1e6),
                     static_cast<std::uint16_t>(std::min(static_cast<int>(x), kWidth - 1)),
                     static_cast<std::uint16_t>(y), e.speed > 0 ? 1 : 0);
  }
  return events;
}

}  // namespace evit::bench
