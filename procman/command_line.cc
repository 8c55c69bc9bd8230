#include "procman/command_line.h"

#include <cctype>
#include <cstdlib>
#include <stdexcept>

namespace evit::procman {
namespace {

bool InName(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class Splitter {
 public:
  Splitter(const std::string& line, const Variables& variables) : line_(line), variables_(variables) {}

  struct Word {
    std::string text;
    bool assigns = false;  // has a = that nothing quoted comes before
  };

  std::vector<Word> Run() {
    while (at_ < line_.size()) {
      const char c = line_[at_++];
      if (c == '\'') {
        Single();
      } else if (c == '"') {
        Double();
      } else if (c == '\\') {
        if (at_ == line_.size()) Fail("ends with a backslash");
        Add(line_[at_++]);
      } else if (c == '$') {
        const std::string value = Variable();
        for (const char v : value) IsSpace(v) ? EndWord() : Add(v);
      } else if (IsSpace(c)) {
        EndWord();
      } else {
        Add(c);
      }
    }
    EndWord();
    return std::move(words_);
  }

 private:
  static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n'; }

  void Add(char c) {
    if (c == '=' && !quoted_) word_.assigns = true;
    word_.text += c;
    in_word_ = true;
  }
  void EndWord() {
    if (in_word_) words_.push_back(std::move(word_));
    word_ = {};
    in_word_ = quoted_ = false;
  }

  void Single() {
    in_word_ = quoted_ = true;
    const std::size_t end = line_.find('\'', at_);
    if (end == std::string::npos) Fail("has an open '");
    word_.text += line_.substr(at_, end - at_);
    at_ = end + 1;
  }

  void Double() {
    in_word_ = quoted_ = true;
    while (true) {
      if (at_ == line_.size()) Fail("has an open \"");
      const char c = line_[at_++];
      if (c == '"') return;
      const bool escapes =
          c == '\\' && at_ < line_.size() && std::string("\"\\$").find(line_[at_]) != std::string::npos;
      if (c == '$') {
        word_.text += Variable();
      } else {
        word_.text += escapes ? line_[at_++] : c;
      }
    }
  }

  // After the $.
  std::string Variable() {
    const bool braces = at_ < line_.size() && line_[at_] == '{';
    const std::size_t begin = braces ? at_ + 1 : at_;
    std::size_t end = begin;
    while (end < line_.size() && InName(line_[end])) ++end;
    const std::string name = line_.substr(begin, end - begin);
    if (braces && (end == line_.size() || line_[end] != '}')) Fail("has an open ${");
    if (name.empty()) Fail("has a $ without a name");
    at_ = braces ? end + 1 : end;
    const std::optional<std::string> value = variables_(name);
    if (!value) Fail("needs the environment variable " + name + ", which is not set");
    return *value;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error("the command line '" + line_ + "' " + what);
  }

  const std::string& line_;
  const Variables& variables_;
  std::size_t at_ = 0;
  std::vector<Word> words_;
  Word word_;
  bool in_word_ = false, quoted_ = false;
};

// The length of NAME in NAME=VALUE, 0 where the word has another form.
std::size_t NameLength(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos || std::isdigit(static_cast<unsigned char>(word[0])) != 0) return 0;
  for (std::size_t i = 0; i < equals; ++i) {
    if (!InName(word[i])) return 0;
  }
  return equals;
}

}  // namespace

CommandLine SplitCommandLine(const std::string& line, const Variables& variables) {
  CommandLine result;
  for (auto& [text, assigns] : Splitter(line, variables).Run()) {
    const std::size_t name = result.words.empty() && assigns ? NameLength(text) : 0;
    if (name > 0) {
      result.environment.emplace_back(text.substr(0, name), text.substr(name + 1));
    } else {
      result.words.push_back(std::move(text));
    }
  }
  if (result.words.empty()) throw std::runtime_error("the command line '" + line + "' names no program");
  return result;
}

CommandLine SplitCommandLine(const std::string& line) {
  return SplitCommandLine(line, [](const std::string& name) -> std::optional<std::string> {
    const char* value = std::getenv(name.c_str());
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  });
}

std::string JoinCommandLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    const bool plain = !word.empty() && word.find_first_of(" \t\n'\"\\$=") == std::string::npos;
    line += plain ? word : "'";
    if (plain) continue;
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace evit::procman
