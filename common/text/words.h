#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace evit {

/// The ASCII letters of a text in lower case, whatever the locale.
inline std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

inline bool IsDigit(char c) { return c >= '0' && c <= '9'; }

inline bool EndsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

}  // namespace evit
