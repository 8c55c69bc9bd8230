#pragma once

#include <cstdint>
#include <vector>

#include "common/events/event.h"

namespace evit {

/// Counts events with their sign: the brightness change of an interval, in contrast thresholds (Bryner et
/// al. 2019, Sec. III).
class EventCounter {
 public:
  using Image = std::vector<std::uint8_t>;  // row-major [height][width]
  static constexpr int kZero = 128;         // value of a pixel without events

  EventCounter(int width, int height) : width_(width), height_(height) {}

  /// Events [begin, end), all inside the image. Each pixel: kZero + brighter - darker, limited to 1..255.
  /// `ignored`: pixels (y * width + x) taken for defect, which become kZero.
  Image Count(const EventArray& events, std::size_t begin, std::size_t end,
              const std::vector<std::int32_t>& ignored);

 private:
  int width_, height_;
  std::vector<std::int16_t> counts_;
};

}  // namespace evit
