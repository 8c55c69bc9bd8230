#include "tools/formats/numpy/npy_table.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace evit::formats {
namespace {

constexpr std::uint64_t kTelling = 1000;  // rows

std::unique_ptr<NpyInput> Open(const std::string& path, const std::string& array) {
  return array.empty() ? OpenNpy(path) : OpenInNpz(path, array);
}

NpyTable TableOf(const std::string& path, const std::string& array, const NpyHeader& header) {
  NpyTable table{path, array, header.rows, {}};
  for (const NpyColumn& column : header.columns) table.columns.push_back({array, header.by_column, column});
  return table;
}

std::string Word(const NpyColumn& column, const std::uint8_t* at) {
  if (column.kind != 'f') return std::to_string(NpyInteger(column, at));
  char text[400];
  std::snprintf(text, sizeof text, "%.9f", NpyNumber(column, at));
  return text;
}

}  // namespace

std::vector<NpyTable> FindNpyTables(const std::string& path) {
  if (!IsNpz(path)) return {TableOf(path, "", ReadNpyHeader(OpenNpy(path).get()))};
  std::vector<NpyTable> tables;
  std::map<std::string, NpyTable> groups;
  for (const std::string& array : NamesInNpz(path)) {
    NpyHeader header;
    try {
      header = ReadNpyHeader(OpenInNpz(path, array).get());
    } catch (const std::runtime_error&) {
      continue;  // a single number, or text
    }
    if (!header.one_dimension) {
      tables.push_back(TableOf(path, array, header));
      continue;
    }
    const std::size_t slash = array.rfind('/');
    const std::string group = slash == std::string::npos ? "" : array.substr(0, slash);
    header.columns.front().name =
        array.substr(slash == std::string::npos ? 0 : slash + 1) + header.columns.front().name;
    NpyTable& table = groups.try_emplace(group, NpyTable{path, group, 0, {}}).first->second;
    // Events are the longest arrays; others count for something else.
    if (header.rows > table.rows) table.columns.clear();
    if (header.rows < table.rows) continue;
    table.rows = header.rows;
    table.columns.push_back({array, false, header.columns.front()});
  }
  for (auto& [name, table] : groups) tables.push_back(std::move(table));
  return tables;
}

TableSample SampleNpy(const NpyTable& table) {
  TableSample sample;
  for (const NpyTable::Column& column : table.columns) {
    if (!column.numbers.name.empty()) sample.head.push_back(column.numbers.name);
  }
  NpyRows rows(table);
  const std::uint64_t n = rows.Read(kTelling);
  for (std::uint64_t k = 0; k < n; ++k) {
    sample.rows.emplace_back();
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      sample.rows.back().push_back(Word(table.columns[c].numbers, rows.At(c, k)));
  }
  return sample;
}

NpyRows::NpyRows(const NpyTable& table) : rows_(table.rows), left_(table.rows) {
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const NpyTable::Column& column = table.columns[k];
    // Columns of an array that stands row by row share its bytes.
    if (k > 0 && !column.by_column && column.array == table.columns[k - 1].array) {
      places_.push_back({streams_.size() - 1, column.numbers.begin});
      continue;
    }
    Stream stream{Open(table.path, column.array), column.numbers.stride, nullptr};
    ReadNpyHeader(stream.input.get());
    if (column.by_column) stream.input->Skip(column.numbers.begin);
    places_.push_back({streams_.size(), column.by_column ? 0 : column.numbers.begin});
    streams_.push_back(std::move(stream));
  }
}

std::uint64_t NpyRows::Read(std::uint64_t n) {
  n = std::min(n, left_);
  if (n == 0) return 0;
  for (Stream& stream : streams_) stream.data = stream.input->Take(n * stream.stride);
  left_ -= n;
  return n;
}

}  // namespace evit::formats
