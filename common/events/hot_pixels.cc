#include "common/events/hot_pixels.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace evit {
namespace {

constexpr int kOverNeighbours = 10;  // a hot pixel fires this much more often than its neighbours

constexpr std::uint16_t kMostCounted = std::numeric_limits<std::uint16_t>::max();

}  // namespace

HotPixels::HotPixels(int width, int height, double rate_hz)
    : width_(width), height_(height), threshold_(rate_hz * ToSeconds(kWindow)) {
  if (threshold_ > 0) counts_.assign(std::size_t(width) * height, 0);
}

void HotPixels::Clear() {
  std::fill(counts_.begin(), counts_.end(), std::uint16_t{0});
  pixels_.clear();
  started_ = false;
}

void HotPixels::AdvanceTo(Utime t) {
  if (counts_.empty()) return;
  if (started_ && t >= window_end_) {
    CloseWindow();
    // A window or more without events: nothing is hot.
    if (t >= window_end_ + kWindow) pixels_.clear();
  }
  if (!started_ || t >= window_end_) {
    const Utime phase = ((t % kWindow) + kWindow) % kWindow;
    window_end_ = t - phase + kWindow;
    started_ = true;
  }
}

void HotPixels::Update(const EventArray& events, std::size_t begin, std::size_t end) {
  if (counts_.empty()) return;
  const auto width = static_cast<unsigned>(width_);
  while (begin < end) {
    if (!started_ || events.t[begin] >= window_end_) AdvanceTo(events.t[begin]);
    const std::uint16_t *const x = events.x.data(), *const y = events.y.data();
    std::uint16_t* const counts = counts_.data();
    const Utime* const t = events.t.data();
    // To the window's end, which few packets reach: without a branch for each event.
    const std::size_t stop =
        t[end - 1] < window_end_
            ? end
            : static_cast<std::size_t>(std::lower_bound(t + begin, t + end, window_end_) - t);
    for (std::size_t i = begin; i < stop; ++i) {
      std::uint16_t& count = counts[y[i] * width + x[i]];
      count = static_cast<std::uint16_t>(count + (count < kMostCounted ? 1 : 0));
    }
    begin = stop;
  }
}

void HotPixels::CloseWindow() {
  pixels_.clear();
  for (int y = 0; y < height_; ++y) {
    const std::uint16_t* const row = counts_.data() + y * std::size_t(width_);
    for (int x = 0; x < width_; ++x) {
      if (row[x] > threshold_ && row[x] > kOverNeighbours * (NeighbourLevel(x, y) + 1)) {
        pixels_.push_back(y * width_ + x);
      }
    }
  }
  std::fill(counts_.begin(), counts_.end(), std::uint16_t{0});
}

int HotPixels::NeighbourLevel(int x, int y) const {
  std::uint16_t around[8];
  int n = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
      if (u != x || v != y) around[n++] = counts_[v * std::size_t(width_) + u];
    }
  }
  if (n < 2) return 0;
  std::nth_element(around, around + 1, around + n, std::greater<>());
  return around[1];
}

}  // namespace evit
