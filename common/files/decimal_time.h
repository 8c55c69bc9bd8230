#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/time/utime.h"

namespace evit {

/// The unit in which a text says a time.
enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// A decimal number of `unit` ("1642661138.836530", "12", "1.642661138299999952e+09") to microseconds without
/// going through a double, which loses microseconds of today's dates. What is finer is rounded. False where
/// the text is not a finite number, or beyond any date.
bool ParseDecimalTime(std::string_view text, TimeUnit unit, Utime* time);

/// The unit of a time since 1970, from how many digits it has before the point: 10 (s), 13 (ms), 16 (us), 19
/// (ns); nothing where it has another number of digits, e.g. because it counts from the start of a recording.
std::optional<TimeUnit> UnitOfDate(std::string_view text);

/// Microseconds to decimal seconds with six decimals.
std::string DecimalSeconds(Utime time);

}  // namespace evit
