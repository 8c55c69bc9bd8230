#pragma once

#include <string>
#include <string_view>

#include "common/time/utime.h"

namespace evit {

/// Decimal seconds ("1642661138.836530", "12", "3.5e1" is refused) to microseconds without going through a
/// double, which loses microseconds of today's dates. Digits beyond the sixth are rounded. False where the
/// text is no such number.
bool ParseDecimalSeconds(std::string_view text, Utime* time);

/// Microseconds to decimal seconds with six decimals.
std::string DecimalSeconds(Utime time);

}  // namespace evit
