#include "common/files/number_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace evit {

NumberRows::NumberRows(const std::string& path, std::string layout, const std::string& what)
    : path_(path), layout_(std::move(layout)), file_(path) {
  if (!file_) throw std::runtime_error(path + ": cannot be read; expected " + what + " (" + layout_ + ")");
}

bool NumberRows::Next() {
  for (std::string text; std::getline(file_, text);) {
    ++line_;
    std::replace(text.begin(), text.end(), ',', ' ');
    row_ = std::istringstream(text);
    if (row_ >> first_ && first_[0] != '#') return true;
  }
  return false;
}

double NumberRows::Number() {
  double value = 0;
  if (!(row_ >> value) || !std::isfinite(value)) Fail("expected finite numbers: " + layout_);
  return value;
}

bool NumberRows::more() { return (row_ >> std::ws).peek() != std::istringstream::traits_type::eof(); }

void NumberRows::Fail(const std::string& what) const {
  throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + what);
}

}  // namespace evit
