#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/decimal_time.h"

namespace evit {

/// Reads numbers from a text file, row by row, at the speed of the disk: no stream, no copy, no locale. The
/// one reader of trajectories, IMU samples, events and clouds, as tolerant as what people's programs write:
/// - words stand apart by blanks, tabs, commas or semicolons, and may be quoted; rows end with LF, CR LF or
/// CR
/// - empty lines are passed over, and what follows '#', '%' or '//'; also lines that begin with ';'
/// - column heads before the first row, with or without '#', become head(); a byte order mark is skipped
/// - numbers may have exponents and signs; "168.0" is a whole number
/// Decimal commas and UTF-16 are refused by name. All failures are std::runtime_error naming file, line and
/// remedy.
class TableReader {
 public:
  /// `layout` says what a row holds, e.g. "t x y p"; it is part of the messages.
  TableReader(const std::string& path, std::string layout);
  /// Of text in memory, from byte `at` on, which must outlive this; `name` stands for the path in messages.
  TableReader(std::string_view text, const std::string& name, std::string layout);

  /// Goes to the next row that holds something; false at the end of the file.
  bool Next();
  /// Names of the columns as they stand before the first row, empty where there are none; after Next().
  const std::vector<std::string>& head() const { return head_; }

  /// The next word of the row as it stands; throws where there is none.
  std::string_view Word();
  /// The next word as ... ; throws where there is none or it is not such a number. `nan` and `inf` are
  /// numbers, but not finite ones.
  double Number();
  double Finite();
  std::int64_t Integer();
  /// A decimal number of `unit`, exact to the microsecond; false where it says nan or inf.
  bool Time(Utime* t, TimeUnit unit = TimeUnit::kSeconds);
  /// Whether the row has more words.
  bool more();
  /// How many words the rest of the row has.
  std::size_t WordsLeft() const;
  /// Whether the file ends within this row, as one does that is cut off: no line end, and fewer than `words`.
  bool CutOff(std::size_t words) const;
  /// Throws unless the row ends here.
  void End();

  [[noreturn]] void Fail(const std::string& what) const;
  std::int64_t line() const { return line_; }
  double share() const;  // of the file that was read, 0..1

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct Input {  // the file, or nothing where the text is in memory
    std::unique_ptr<std::FILE, Close> file;
    std::vector<char> buffer;
    double size = 0, n_read = 0;  // bytes
  };

  bool Refill();
  const char* NextNewline();
  bool NextLine();
  void SkipByteOrderMark();
  bool TakeHead();
  void RefuseDecimalCommas() const;

  std::string path_, layout_;
  Input input_;
  const char *at_ = nullptr, *line_end_ = nullptr;  // the rest of the line
  const char *next_ = nullptr, *end_ = nullptr;     // the rest of the buffer
  const char* newline_ = nullptr;                   // in it, if known
  std::int64_t line_ = 0;
  bool in_rows_ = false;  // the first row has been seen: no more heads
  std::vector<std::string> head_;
};

/// The whole word as a number, with sign and exponent as they come; false where it is none.
bool ParseNumber(std::string_view word, double* value);

}  // namespace evit
