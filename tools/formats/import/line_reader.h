#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/time/utime.h"

namespace evit::formats {

/// Reads numbers from a text file, line by line, at the speed of the disk: no stream, no copy, no locale.
/// Words stand apart by blanks, tabs or commas; empty lines and those that begin with '#' are passed over.
/// All failures are std::runtime_error naming file, line and remedy.
class LineReader {
 public:
  /// `layout` says what a line holds, e.g. "t x y p"; it is part of the messages.
  LineReader(const std::string& path, std::string layout);

  /// Goes to the next line that holds something; false at the end of the file.
  bool Next();

  /// The next word as ... ; throws where there is none or it is not such a number. `nan` and `inf` are
  /// numbers.
  double Number();
  std::int64_t Integer();
  /// Decimal seconds, exact to the microsecond; false where it says nan or inf.
  bool Time(Utime* t);
  /// Throws unless the line ends here.
  void End();

  [[noreturn]] void Fail(const std::string& what) const;
  double share() const;  // of the file that was read, 0..1

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool Refill();
  std::string_view Word();

  std::string path_, layout_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<char> buffer_;
  const char *at_ = nullptr, *line_end_ = nullptr;  // the rest of the line
  const char *next_ = nullptr, *end_ = nullptr;     // the rest of the buffer
  std::int64_t line_ = 0;
  double size_ = 0, n_read_ = 0;  // bytes
};

}  // namespace evit::formats
