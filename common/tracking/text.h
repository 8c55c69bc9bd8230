#pragma once

#include <cstdio>
#include <string>

namespace evit {

/// printf for one or two numbers.
inline std::string Text(const char* format, double a, double b = 0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace evit
