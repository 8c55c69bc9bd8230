#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace evit {

/// Like std::sprintf, into a string: up to 999 characters, further ones are cut off.
__attribute__((format(printf, 1, 2))) inline std::string FormatText(const char* format, ...) {
  char text[1000];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace evit
