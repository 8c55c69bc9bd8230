#include "common/files/decimal_time.h"

#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "common/text/words.h"

namespace evit {
namespace {

constexpr int kMaxDigits = 17;  // of a time in us: 3000 years

// A decimal number taken apart: 0.DIGITS * 10^point. Leading zeros are left out.
struct Decimal {
  char digits[40];  // more do not change the microsecond
  int n = 0, point = 0;
  bool negative = false;
};

bool TakeApart(std::string_view text, Decimal* out) {
  std::size_t k = 0;
  out->negative = !text.empty() && text[0] == '-';
  if (out->negative || (!text.empty() && text[0] == '+')) ++k;
  bool any = false, after_point = false;
  for (; k < text.size() && (IsDigit(text[k]) || (text[k] == '.' && !after_point)); ++k) {
    if (text[k] == '.') {
      after_point = true;
      continue;
    }
    any = true;
    const bool leading_zero = out->n == 0 && text[k] == '0';
    if (!leading_zero && out->n < static_cast<int>(sizeof out->digits)) out->digits[out->n++] = text[k];
    if (after_point ? leading_zero : !leading_zero) out->point += after_point ? -1 : 1;
  }
  if (!any) return false;
  if (k < text.size() && (text[k] == 'e' || text[k] == 'E')) {
    ++k;
    if (k < text.size() && text[k] == '+') ++k;
    int exponent = 0;
    const auto [end, error] = std::from_chars(text.data() + k, text.data() + text.size(), exponent);
    if (error != std::errc() || exponent < -1000 || exponent > 1000) return false;
    out->point += exponent;
    k = static_cast<std::size_t>(end - text.data());
  }
  return k == text.size();
}

// Power of ten that turns the unit into microseconds.
int PowerOf(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::kSeconds:
      return 6;
    case TimeUnit::kMilliseconds:
      return 3;
    case TimeUnit::kMicroseconds:
      return 0;
    case TimeUnit::kNanoseconds:
      return -3;
  }
  return 0;
}

}  // namespace

bool ParseDecimalTime(std::string_view text, TimeUnit unit, Utime* time) {
  Decimal number;
  if (!TakeApart(text, &number)) return false;
  const int whole = number.n == 0 ? 0 : number.point + PowerOf(unit);  // digits before the point, in us
  if (whole > kMaxDigits) return false;
  Utime micros = 0;
  for (int k = 0; k < whole; ++k) micros = micros * 10 + (k < number.n ? number.digits[k] - '0' : 0);
  if (whole >= 0 && whole < number.n && number.digits[whole] >= '5') ++micros;
  *time = number.negative ? -micros : micros;
  return true;
}

std::optional<TimeUnit> UnitOfDate(std::string_view text) {
  Decimal number;
  if (!TakeApart(text, &number) || number.negative || number.n == 0) return {};
  switch (number.point) {
    case 10:
      return TimeUnit::kSeconds;
    case 13:
      return TimeUnit::kMilliseconds;
    case 16:
      return TimeUnit::kMicroseconds;
    case 19:
      return TimeUnit::kNanoseconds;
    default:
      return {};
  }
}

std::string DecimalSeconds(Utime time) {
  char text[40];
  const Utime magnitude = std::llabs(time);
  std::snprintf(text, sizeof text, "%s%lld.%06lld", time < 0 ? "-" : "",
                static_cast<long long>(magnitude / kMicrosPerSecond),
                static_cast<long long>(magnitude % kMicrosPerSecond));
  return text;
}

}  // namespace evit
