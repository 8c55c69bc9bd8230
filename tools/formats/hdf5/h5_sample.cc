#include "tools/formats/hdf5/h5_sample.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace evit::formats {
namespace {

constexpr std::size_t kRows = 1000;

std::string Word(double value) {
  char text[400];
  std::snprintf(text, sizeof text, "%.9f", value);
  return text;
}

}  // namespace

TableSample SampleColumns(const std::vector<const H5Rows*>& columns, const std::string& head) {
  TableSample sample;
  std::istringstream names(head);
  for (std::string name; names >> name;) sample.head.push_back(name);
  for (const H5Rows* rows : columns) {
    const std::size_t n = std::min(rows->rows(), kRows), width = rows->columns();
    if (width > kRows) rows->Fail("has rows of " + std::to_string(width) + " numbers");
    sample.rows.resize(n);
    const auto add = [&](const auto& numbers, const auto& word) {
      for (std::size_t k = 0; k < numbers.size(); ++k) sample.rows[k / width].push_back(word(numbers[k]));
    };
    if (rows->is_integer()) {
      std::vector<std::int64_t> whole;
      rows->Read(0, n, &whole);
      add(whole, [](std::int64_t value) { return std::to_string(value); });
    } else {
      std::vector<double> numbers;
      rows->Read(0, n, &numbers);
      add(numbers, Word);
    }
  }
  return sample;
}

}  // namespace evit::formats
