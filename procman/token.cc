#include "procman/token.h"

#include <cctype>
#include <stdexcept>

namespace evit::procman {
namespace {

class Lexer {
 public:
  Lexer(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  std::vector<Token> Run() {
    std::vector<Token> tokens;
    while (SkipSpace()) tokens.push_back(Next());
    tokens.push_back({Token::Kind::kEnd, "the end of the file", line_});
    return tokens;
  }

 private:
  // False at the end.
  bool SkipSpace() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      }
      if (at_ == text_.size()) break;
      if (text_[at_] == '\n') ++line_;
      if (std::isspace(static_cast<unsigned char>(text_[at_])) == 0) return true;
    }
    return false;
  }

  static bool InWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  }
  static bool IsDigit(char c) { return c >= '0' && c <= '9'; }

  Token Next() {
    const char c = text_[at_];
    if (c == '"') return Quoted();
    if (c == '{' || c == '}' || c == '=' || c == ';' || c == ',') {
      ++at_;
      return {Token::Kind::kSign, std::string(1, c), line_};
    }
    if (!InWord(c)) Fail(std::string("unexpected character '") + c + "'");
    Token token{Token::Kind::kNumber, "", line_};
    for (; at_ < text_.size() && InWord(text_[at_]); ++at_) {
      if (!IsDigit(text_[at_])) token.kind = Token::Kind::kWord;
      token.text += text_[at_];
    }
    return token;
  }

  Token Quoted() {
    Token token{Token::Kind::kText, "", line_};
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      char c = text_[at_];
      if (c == '\n') Fail("a quoted text is not closed by \" on its line");
      if (c == '\\' && at_ + 1 < text_.size()) {
        const char next = text_[at_ + 1];
        // Other backslashes belong to the command line, which has its own quoting.
        if (next == '"' || next == '\\') {
          c = next;
          ++at_;
        } else if (next == 'n') {
          c = '\n';
          ++at_;
        }
      }
      token.text += c;
    }
    if (at_ == text_.size()) Fail("a quoted text is not closed by \" before the end of the file");
    ++at_;
    return token;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::vector<Token> Tokenize(const std::string& text, const std::string& file) {
  return Lexer(text, file).Run();
}

}  // namespace evit::procman
