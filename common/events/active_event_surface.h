#pragma once

#include <cstdint>
#include <vector>

#include "common/time/utime.h"

namespace evit {

/// Surface of active events (paper Sec. III-B.2): the time of the newest event of each pixel, of either
/// polarity.
///
/// Times are kept as 32-bit microseconds since a base that moves along, so that a VGA sensor's fit the cache
/// (1.2 MB) and one pass over them is vectorised.
class ActiveEventSurface {
 public:
  static constexpr std::int32_t kNever = -1'000'000'000;  // stamp of a pixel without events

  /// Both sides in pixels, above zero.
  ActiveEventSurface(int width, int height);

  /// Consecutive events with times not decreasing, before all of them those of earlier calls. Events outside
  /// the image are counted and dropped. No allocation.
  void Update(const Utime* t, const std::uint16_t* x, const std::uint16_t* y, std::size_t n);
  /// Forgets all events.
  void Clear();

  int width() const { return width_; }
  int height() const { return height_; }
  std::int64_t outside() const { return outside_; }
  /// Row-major [height][width], relative to base().
  const std::int32_t* stamps() const { return stamps_.data(); }
  Utime base() const { return base_; }
  /// t relative to base(), limited so that its distance to any stamp fits 32 bits. Requires t >= base().
  std::int32_t Relative(Utime t) const;

 private:
  void MoveBase(Utime t);
  void UpdateWithinBase(const Utime* t, const std::uint16_t* x, const std::uint16_t* y, std::size_t n);

  int width_, height_;
  Utime base_ = 0;
  bool has_base_ = false;
  std::int64_t outside_ = 0;
  std::vector<std::int32_t> stamps_;  // [height][width]
};

}  // namespace evit
