#include "common/events/event_counter.h"

#include <algorithm>

namespace evit {

EventCounter::Image EventCounter::Count(const EventArray& events, std::size_t begin, std::size_t end,
                                        const std::vector<std::int32_t>& ignored) {
  constexpr int kMost = 127;  // either way
  counts_.assign(static_cast<std::size_t>(width_) * height_, 0);
  for (std::size_t i = begin; i < end; ++i) {
    std::int16_t& count = counts_[events.y[i] * static_cast<std::size_t>(width_) + events.x[i]];
    const int next = count + (events.p[i] != 0 ? 1 : -1);
    count = static_cast<std::int16_t>(std::clamp(next, -16'000, 16'000));
  }
  for (const std::int32_t pixel : ignored) counts_[static_cast<std::size_t>(pixel)] = 0;
  Image image(counts_.size());
  for (std::size_t k = 0; k < image.size(); ++k) {
    image[k] = static_cast<std::uint8_t>(kZero + std::clamp<int>(counts_[k], -kMost, kMost));
  }
  return image;
}

}  // namespace evit
