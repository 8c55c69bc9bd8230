#pragma once

#include <cstdint>

namespace evit::formats {

/// The upper part of a sensor's clock, `bits` wide, as EVT streams repeat it: made continuous where it wraps.
/// Transmission turns single bits now and then; a value that the next one does not confirm is ignored.
template <int bits>
class TimeHigh {
 public:
  bool known() const { return known_; }
  /// Negative where the clock slips back right after the start: to be multiplied, not shifted.
  std::int64_t value() const { return value_; }
  /// Whether `high` is an ordinary successor: the same, or one more.
  bool Ordinary(std::uint32_t high) const { return known_ && Distance(high) <= 1; }
  /// Takes an ordinary value; true where the time has changed.
  bool Step(std::uint32_t high) {
    const std::int64_t d = Distance(high);
    value_ += d;
    return d != 0;
  }
  /// Takes any other value if `next`, the one behind it in the stream, fits it better than what is known.
  bool Jump(std::uint32_t high, std::uint32_t next) {
    const std::int64_t from_new = (static_cast<std::int64_t>(next) - high) & kMask;
    if (known_ && Distance(next) <= from_new) return false;
    return Set(high);
  }
  /// The same where nothing follows: only the first value, or a short step onwards, is believed.
  bool JumpAlone(std::uint32_t high) {
    constexpr std::int64_t kShort = 16;
    if (known_ && Distance(high) > kShort) return false;
    return Set(high);
  }

 private:
  static constexpr std::int64_t kMask = (std::int64_t{1} << bits) - 1;
  // Sensors slip backwards by a few units at most; any other earlier value means that the counter has
  // wrapped.
  static constexpr std::int64_t kSlip = 16;

  std::int64_t Distance(std::uint32_t high) const {
    return (static_cast<std::int64_t>(high) - value_) & kMask;
  }
  bool Set(std::uint32_t high) {
    std::int64_t d = known_ ? Distance(high) : static_cast<std::int64_t>(high);
    if (known_ && d > kMask - kSlip) d -= kMask + 1;
    value_ += d;
    known_ = true;
    return true;
  }

  std::int64_t value_ = 0;
  bool known_ = false;
};

}  // namespace evit::formats
