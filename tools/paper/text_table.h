#pragma once

#include <string>
#include <vector>

namespace evit::paper {

/// Rows of text, as they are printed.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  std::string Markdown() const;
  std::string Csv() const;  // RFC 4180
};

}  // namespace evit::paper
