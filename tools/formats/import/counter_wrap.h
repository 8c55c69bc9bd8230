#pragma once

#include "common/time/utime.h"

namespace evit::formats {

/// Continues a sensor's counter of microseconds where it wraps: at 2^24 (EVT 3.0), 2^31 or 2^32, with or
/// without sign. A wrap is a step from just before the one end to just behind the other; any other step back
/// is left to TimeOrder. Events that come late over a wrap go back before it.
class CounterWrap {
 public:
  /// The continued stamp of the next event.
  Utime Continue(Utime t) {
    const Utime step = t - last_;
    if (step < -kFar || step > kFar) {
      for (const Counter& counter : kCounters) {
        const bool was_at_end = last_ >= counter.end - counter.near && last_ < counter.end,
                   was_at_begin = last_ < counter.end - counter.span + counter.near &&
                                  last_ >= counter.end - counter.span;
        const Utime same = t + (was_at_end ? counter.span : -counter.span);
        const Utime distance = same - last_;
        if (distance < -counter.near || distance > counter.near) continue;
        if (was_at_end && t >= counter.end - counter.span) {
          base_ += counter.span;
          break;
        }
        if (was_at_begin && base_ >= counter.span && t < counter.end) return base_ - counter.span + t;
      }
    }
    last_ = t;
    return base_ + t;
  }

 private:
  struct Counter {
    Utime end, span,
        near;  // one behind the last stamp, number of stamps, how far from the ends a wrap may be
  };
  static constexpr Utime kFar = Utime{1} << 23;  // half of the smallest counter
  static constexpr Counter kCounters[] = {{Utime{1} << 24, Utime{1} << 24, 100'000},
                                          {Utime{1} << 31, Utime{1} << 31, 1'000'000},
                                          {Utime{1} << 31, Utime{1} << 32, 1'000'000},
                                          {Utime{1} << 32, Utime{1} << 32, 1'000'000}};

  Utime last_ = 0, base_ = 0;
};

}  // namespace evit::formats
