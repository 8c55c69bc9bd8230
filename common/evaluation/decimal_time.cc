#include "common/evaluation/decimal_time.h"

#include <cctype>
#include <cstdio>
#include <cstdlib>

namespace evit {

bool ParseDecimalSeconds(std::string_view text, Utime* time) {
  std::size_t k = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (negative || (!text.empty() && text[0] == '+')) ++k;
  Utime micros = 0;
  int digits = 0, decimals = 0;
  for (; k < text.size() && std::isdigit(static_cast<unsigned char>(text[k])) != 0; ++k, ++digits) {
    if (digits > 11) return false;  // beyond any date
    micros = micros * 10 + (text[k] - '0');
  }
  micros *= kMicrosPerSecond;
  if (k < text.size() && text[k] == '.') {
    Utime unit = kMicrosPerSecond / 10;
    for (++k; k < text.size() && std::isdigit(static_cast<unsigned char>(text[k])) != 0; ++k, ++decimals) {
      if (decimals < 6) micros += (text[k] - '0') * unit;
      if (decimals == 6 && text[k] >= '5') ++micros;
      unit /= 10;
    }
  }
  if (k != text.size() || digits + decimals == 0) return false;
  *time = negative ? -micros : micros;
  return true;
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
