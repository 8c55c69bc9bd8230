#pragma once

#include <string>
#include <vector>

namespace evit::procman {

/// One word of a procman file.
struct Token {
  enum class Kind { kWord, kText, kNumber, kSign, kEnd };
  Kind kind = Kind::kEnd;
  std::string text;  // kText: without its quotes
  int line = 0;
};

/// Splits a procman file into words, quoted texts, whole numbers and the signs { } = ; , '#' begins a
/// comment. The last token is kEnd. Throws std::runtime_error naming `file` and the line.
std::vector<Token> Tokenize(const std::string& text, const std::string& file);

}  // namespace evit::procman
