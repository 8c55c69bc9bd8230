#pragma once

#include <string_view>

namespace evit {

/// The order people give files: numbers in names by their value, 2.png before 10.png.
inline bool NaturallyBefore(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  // The number whose digits begin at `at`, which moves behind them, without leading zeros.
  const auto digits = [&](std::string_view name, std::size_t* at) {
    while (*at < name.size() && name[*at] == '0') ++*at;
    const std::size_t begin = *at;
    while (*at < name.size() && is_digit(name[*at])) ++*at;
    return name.substr(begin, *at - begin);
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view m = digits(a, &i), n = digits(b, &j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  if (i < a.size() || j < b.size()) return j < b.size();
  return a < b;  // the same but for leading zeros
}

}  // namespace evit
