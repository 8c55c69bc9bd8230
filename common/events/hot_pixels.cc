#include "common/events/hot_pixels.h"

#include <algorithm>
#include <functional>

namespace evit {
namespace {

constexpr int kOverNeighbours = 10;  // a hot pixel fires this much more often than its neighbours

}  // namespace

HotPixels::HotPixels(int width, int height, double rate_hz)
    : width_(width), height_(height), threshold_(rate_hz * ToSeconds(kWindow)) {
  if (threshold_ <= 0) return;
  fine_.assign(std::size_t(width) * height, 0);
  coarse_.assign(fine_.size(), 0);
}

void HotPixels::Clear() {
  ClearCounts();
  pixels_.clear();
  started_ = false;
}

void HotPixels::ClearCounts() {
  std::fill(fine_.begin(), fine_.end(), std::uint8_t{0});
  std::fill(coarse_.begin(), coarse_.end(), std::uint16_t{0});
}

void HotPixels::AdvanceTo(Utime t) {
  if (fine_.empty()) return;
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
  if (fine_.empty()) return;
  const auto width = static_cast<unsigned>(width_);
  while (begin < end) {
    if (!started_ || events.t[begin] >= window_end_) AdvanceTo(events.t[begin]);
    const std::uint16_t *const x = events.x.data(), *const y = events.y.data();
    std::uint8_t* const fine = fine_.data();
    const Utime* const t = events.t.data();
    // To the window's end, which few packets reach: times need not be compared for each event.
    const std::size_t stop =
        t[end - 1] < window_end_
            ? end
            : static_cast<std::size_t>(std::lower_bound(t + begin, t + end, window_end_) - t);
    for (std::size_t i = begin; i < stop; ++i) {
      const unsigned pixel = y[i] * width + x[i];
      if (++fine[pixel] == 0) ++coarse_[pixel];
    }
    begin = stop;
  }
}

void HotPixels::CloseWindow() {
  pixels_.clear();
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const int count = CountOf(y * std::size_t(width_) + x);
      if (count > threshold_ && count > kOverNeighbours * (NeighbourLevel(x, y) + 1)) {
        pixels_.push_back(y * width_ + x);
      }
    }
  }
  ClearCounts();
}

int HotPixels::NeighbourLevel(int x, int y) const {
  int around[8];
  int n = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
      if (u != x || v != y) around[n++] = CountOf(v * std::size_t(width_) + u);
    }
  }
  if (n < 2) return 0;
  std::nth_element(around, around + 1, around + n, std::greater<>());
  return around[1];
}

}  // namespace evit
