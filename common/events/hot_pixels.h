#pragma once

#include <cstdint>
#include <vector>

#include "common/events/event.h"

namespace evit {

/// Finds pixels that fire without cause: above a rate, and far above the second busiest of their eight
/// neighbours (not the median: pixels of a thin line that shakes have two busy neighbours, and six idle
/// ones). Counts events in windows of data time (never the host's), so the same events give the same pixels
/// however they arrive.
class HotPixels {
 public:
  static constexpr Utime kWindow = 500'000;  // us

  /// `rate_hz`: events/s above which a pixel may be hot; 0 turns this off.
  HotPixels(int width, int height, double rate_hz);

  /// Events [begin, end) inside the image, in time order after all of earlier calls.
  void Update(const EventArray& events, std::size_t begin, std::size_t end);
  /// Time has come to t without (more) events.
  void AdvanceTo(Utime t);
  void Clear();

  /// Pixels (y * width + x) found in the last whole window, ascending.
  const std::vector<std::int32_t>& pixels() const { return pixels_; }

 private:
  void CloseWindow();
  void ClearCounts();
  int CountOf(std::size_t pixel) const { return fine_[pixel] + 256 * coarse_[pixel]; }
  int NeighbourLevel(int x, int y) const;

  int width_, height_;
  double threshold_;  // events per window
  Utime window_end_ = 0;
  bool started_ = false;
  // [height][width]: a pixel's count modulo 256, and how often that went round. Nearly all counts are small,
  // and the bytes are what stays in the cache.
  std::vector<std::uint8_t> fine_;
  std::vector<std::uint16_t> coarse_;
  std::vector<std::int32_t> pixels_;
};

}  // namespace evit
