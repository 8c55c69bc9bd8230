#include "common/files/table_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "common/text/words.h"

namespace evit {
namespace {

constexpr std::size_t kBuffer = 1 << 20;  // bytes; no row of numbers is as long
constexpr double kMaxWhole = 9e15;        // a double holds whole numbers up to here

bool IsGap(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\r' || c == ';' || c == '"' || c == '\'';
}
bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool IsCommentSign(char c) { return c == '#' || c == '%' || c == ';' || c == '/'; }
// The whole word as a number; none of its characters may be left over.
template <typename T>
bool Parse(std::string_view word, T* value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);  // from_chars knows no plus
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

// Where the next word or the end is; what a comment leaves of the line is nothing.
const char* SkipGaps(const char* at, const char* end) {
  at = std::find_if_not(at, end, IsGap);
  if (at == end) return end;
  const bool comment = *at == '#' || *at == '%' || (*at == '/' && at + 1 != end && at[1] == '/');
  return comment ? end : at;
}

std::vector<std::string> Words(const char* at, const char* end) {
  std::vector<std::string> words;
  while ((at = std::find_if_not(at, end, IsGap)) != end) {
    const char* begin = at;
    at = std::find_if(at, end, IsGap);
    words.emplace_back(begin, at);
  }
  return words;
}

}  // namespace

bool ParseNumber(std::string_view word, double* value) { return Parse(word, value); }

TableReader::TableReader(const std::string& path, std::string layout)
    : path_(path), layout_(std::move(layout)) {
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw std::runtime_error(path + ": there is no such file; expected a text file (" + layout_ + ")");
  input_.file.reset(std::fopen(path.c_str(), "rb"));
  if (!input_.file || std::filesystem::is_directory(path, error))
    throw std::runtime_error(path + ": cannot be read; expected a text file (" + layout_ + ")");
  input_.size = static_cast<double>(std::filesystem::file_size(path, error));
  input_.buffer.resize(kBuffer);
  next_ = end_ = input_.buffer.data();
  SkipByteOrderMark();
}

TableReader::TableReader(std::string_view text, const std::string& name, std::string layout)
    : path_(name), layout_(std::move(layout)), next_(text.data()), end_(text.data() + text.size()) {
  input_.size = input_.n_read = static_cast<double>(text.size());
  SkipByteOrderMark();
}

void TableReader::SkipByteOrderMark() {
  while (end_ - next_ < 3 && Refill()) {
  }
  const std::string_view begin(next_, std::min<std::ptrdiff_t>(3, end_ - next_));
  if (begin == "\xEF\xBB\xBF") next_ += 3;
  if (begin.substr(0, 2) == "\xFF\xFE" || begin.substr(0, 2) == "\xFE\xFF")
    throw std::runtime_error(path_ + ": is UTF-16 text; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)");
}

bool TableReader::Refill() {
  if (!input_.file) return false;
  std::vector<char>& buffer = input_.buffer;
  const std::size_t kept = end_ - next_;
  if (kept == buffer.size())
    Fail("the line does not end; expected a text file with lines \"" + layout_ + "\"");
  std::memmove(buffer.data(), next_, kept);
  const std::size_t n = std::fread(buffer.data() + kept, 1, buffer.size() - kept, input_.file.get());
  if (n == 0 && std::ferror(input_.file.get()) != 0) Fail("reading failed; check the disk or the network");
  next_ = buffer.data();
  newline_ = nullptr;
  end_ = next_ + kept + n;
  input_.n_read += static_cast<double>(n);
  return n > 0;
}

// The next LF, or the end of what was read; looked for once, however many CRs come before it.
const char* TableReader::NextNewline() {
  if (newline_ == nullptr || newline_ < next_) {
    newline_ = static_cast<const char*>(std::memchr(next_, '\n', end_ - next_));
    if (newline_ == nullptr) newline_ = end_;
  }
  return newline_;
}

// at_ and line_end_ become the next line's, without what ends it. A CR alone ends a line as well.
bool TableReader::NextLine() {
  if (next_ == end_ && !Refill()) return false;
  ++line_;
  while (true) {
    const char* newline = NextNewline();
    const auto* cr = static_cast<const char*>(std::memchr(next_, '\r', newline - next_));
    const bool alone = cr != nullptr && cr + 1 != newline;
    if (!alone && newline == end_ && Refill()) continue;
    newline = NextNewline();
    at_ = next_;
    line_end_ = alone ? cr : newline;
    next_ = alone ? cr + 1 : (newline != end_ ? newline + 1 : end_);
    return true;
  }
}

bool TableReader::Next() {
  while (NextLine()) {
    if (!in_rows_ && TakeHead()) continue;
    const char* first = std::find_if_not(at_, line_end_, IsBlank);
    at_ = first != line_end_ && *first == ';' ? line_end_ : SkipGaps(first, line_end_);
    if (at_ == line_end_) continue;
    if (!in_rows_) RefuseDecimalCommas();
    in_rows_ = true;
    return true;
  }
  return false;
}

// Before the first row: whether the line is none. A line without any number, commented or not, names the
// columns; the last such line counts.
bool TableReader::TakeHead() {
  const char* begin = std::find_if_not(at_, line_end_, IsBlank);
  if (begin == line_end_) return true;
  const bool comment = *begin == ';' || SkipGaps(begin, line_end_) == line_end_;
  if (comment) begin = std::find_if_not(begin, line_end_, IsCommentSign);
  std::vector<std::string> words = Words(begin, line_end_);
  double value = 0;
  const bool numbers =
      std::any_of(words.begin(), words.end(), [&](const std::string& w) { return Parse(w, &value); });
  if (numbers) return comment;
  if (!words.empty()) head_ = std::move(words);
  return true;
}

// "0,31 0,29" reads as four whole numbers: commas between digits, no point, and other gaps between the
// numbers.
void TableReader::RefuseDecimalCommas() const {
  const std::string_view line(at_, line_end_ - at_);
  bool decimal = false, other_gap = false;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    const bool between = IsDigit(line[k - 1]) && (IsDigit(line[k + 1]) || line[k + 1] == '-');
    if (line[k] == '.') return;
    decimal |= line[k] == ',' && between;
    other_gap |= (line[k] == ' ' || line[k] == '\t' || line[k] == ';') && between;
  }
  if (decimal && other_gap)
    Fail("the numbers have decimal commas; export the file with decimal points (LC_NUMERIC=C)");
}

std::string_view TableReader::Word() {
  at_ = SkipGaps(at_, line_end_);
  const char* begin = at_;
  at_ = std::find_if(at_, line_end_, IsGap);
  if (begin == at_) Fail("the line ends too early; expected \"" + layout_ + "\"; is the file cut off?");
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

double TableReader::Number() {
  const std::string_view word = Word();
  double value = 0;
  if (!Parse(word, &value))
    Fail("\"" + std::string(word) + "\" is not a number; expected \"" + layout_ + "\"");
  return value;
}

double TableReader::Finite() {
  const double value = Number();
  if (!std::isfinite(value)) Fail("expected finite numbers: \"" + layout_ + "\"");
  return value;
}

std::int64_t TableReader::Integer() {
  const std::string_view word = Word();
  std::int64_t value = 0;
  if (Parse(word, &value)) return value;
  double number = 0;
  if (!Parse(word, &number) || !(std::abs(number) < kMaxWhole) || number != std::floor(number))
    Fail("\"" + std::string(word) + "\" is not a whole number; expected \"" + layout_ + "\"");
  return static_cast<std::int64_t>(number);
}

bool TableReader::Time(Utime* t, TimeUnit unit) {
  const std::string_view word = Word();
  if (ParseDecimalTime(word, unit, t)) return true;
  double value = 0;
  if (Parse(word, &value) && !std::isfinite(value)) return false;
  Fail("\"" + std::string(word) + "\" is not a time; expected \"" + layout_ + "\"");
}

bool TableReader::more() { return SkipGaps(at_, line_end_) != line_end_; }

std::size_t TableReader::WordsLeft() const {
  std::size_t n = 0;
  for (const char* at = SkipGaps(at_, line_end_); at != line_end_; at = SkipGaps(at, line_end_)) {
    at = std::find_if(at, line_end_, IsGap);
    ++n;
  }
  return n;
}

bool TableReader::CutOff(std::size_t words) const {
  return line_end_ == end_ && next_ == end_ && input_.n_read >= input_.size && WordsLeft() < words;
}

void TableReader::End() {
  if (more()) Fail("more than \"" + layout_ + "\": is it the right file?");
}

void TableReader::Fail(const std::string& what) const {
  std::string printable = what.substr(0, 300);  // damaged files quote whatever they hold
  std::replace_if(
      printable.begin(), printable.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + printable);
}

double TableReader::share() const {
  return input_.size > 0 ? (input_.n_read - static_cast<double>(end_ - next_)) / input_.size : 1;
}

}  // namespace evit
