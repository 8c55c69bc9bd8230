#include "tools/formats/import/line_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "common/evaluation/decimal_time.h"

namespace evit::formats {
namespace {

constexpr std::size_t kBuffer = 1 << 20;  // bytes; no line of numbers is as long

bool IsGap(char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r'; }

// The whole word as a number; none of its characters may be left over.
template <typename T>
bool Parse(std::string_view word, T* value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

LineReader::LineReader(const std::string& path, std::string layout)
    : path_(path), layout_(std::move(layout)), buffer_(kBuffer) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw std::runtime_error(path + ": there is no such file");
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_ || std::filesystem::is_directory(path, error))
    throw std::runtime_error(path + ": cannot be read; expected a text file");
  size_ = static_cast<double>(std::filesystem::file_size(path, error));
  next_ = end_ = buffer_.data();
}

bool LineReader::Refill() {
  const std::size_t kept = end_ - next_;
  if (kept == buffer_.size())
    Fail("the line does not end; expected a text file with lines \"" + layout_ + "\"");
  std::memmove(buffer_.data(), next_, kept);
  const std::size_t n = std::fread(buffer_.data() + kept, 1, buffer_.size() - kept, file_.get());
  if (n == 0 && std::ferror(file_.get()) != 0) Fail("reading failed; check the disk or the network");
  next_ = buffer_.data();
  end_ = next_ + kept + n;
  n_read_ += static_cast<double>(n);
  return n > 0;
}

bool LineReader::Next() {
  while (true) {
    const auto find = [&] { return static_cast<const char*>(std::memchr(next_, '\n', end_ - next_)); };
    const char* newline = find();
    bool more = true;
    ++line_;
    while (newline == nullptr && more) {
      more = Refill();
      newline = find();
    }
    if (newline == nullptr && next_ == end_) return false;
    at_ = next_;
    line_end_ = newline != nullptr ? newline : end_;
    next_ = newline != nullptr ? newline + 1 : end_;
    at_ = std::find_if_not(at_, line_end_, IsGap);
    if (at_ != line_end_ && *at_ != '#') return true;
  }
}

std::string_view LineReader::Word() {
  at_ = std::find_if_not(at_, line_end_, IsGap);
  const char* begin = at_;
  at_ = std::find_if(at_, line_end_, IsGap);
  if (begin == at_) Fail("the line ends too early; expected \"" + layout_ + "\"; is the file cut off?");
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

double LineReader::Number() {
  const std::string_view word = Word();
  double value = 0;
  if (!Parse(word, &value))
    Fail("\"" + std::string(word) + "\" is not a number; expected \"" + layout_ + "\"");
  return value;
}

std::int64_t LineReader::Integer() {
  const std::string_view word = Word();
  std::int64_t value = 0;
  if (!Parse(word, &value))
    Fail("\"" + std::string(word) + "\" is not a whole number; expected \"" + layout_ + "\"");
  return value;
}

bool LineReader::Time(Utime* t) {
  const std::string_view word = Word();
  if (ParseDecimalSeconds(word, t)) return true;
  double value = 0;
  if (Parse(word, &value) && !std::isfinite(value)) return false;
  Fail("\"" + std::string(word) + "\" is not a time in decimal seconds (no exponent); expected \"" + layout_ +
       "\"");
}

void LineReader::End() {
  at_ = std::find_if_not(at_, line_end_, IsGap);
  if (at_ != line_end_) Fail("more than \"" + layout_ + "\": is it the right file?");
}

void LineReader::Fail(const std::string& what) const {
  throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + what);
}

double LineReader::share() const {
  return size_ > 0 ? (n_read_ - static_cast<double>(end_ - next_)) / size_ : 1;
}

}  // namespace evit::formats
