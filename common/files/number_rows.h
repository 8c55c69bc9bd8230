#pragma once

#include <fstream>
#include <sstream>
#include <string>

namespace evit {

/// The rows of a text file: a word, usually a time, then numbers. Blanks or commas stand between them; empty
/// lines and those that begin with '#' are skipped. All failures are std::runtime_error naming file, line and
/// what was expected.
class NumberRows {
 public:
  /// `layout`: the names of a row's fields, e.g. "t x y z". `what`: the kind of file, for the message where
  /// it cannot be read.
  NumberRows(const std::string& path, std::string layout, const std::string& what);

  /// Goes to the next row; false at the end of the file.
  bool Next();

  /// The first word of the row.
  const std::string& first() const { return first_; }
  /// The next number of the row, which is finite.
  double Number();
  /// Whether the row has more words.
  bool more();

  [[noreturn]] void Fail(const std::string& what) const;

 private:
  std::string path_, layout_, first_;
  std::ifstream file_;
  std::istringstream row_;
  int line_ = 0;
};

}  // namespace evit
