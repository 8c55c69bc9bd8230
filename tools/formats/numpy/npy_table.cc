#include "tools/formats/numpy/npy_table.h"

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

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

// "imu_gyro", "events_t": what an archive without parts puts in front of names.
std::string WithoutPrefix(const std::string& name, std::initializer_list<const char*> prefixes) {
  for (const std::string prefix : prefixes) {
    if (name.size() > prefix.size() && name.rfind(prefix, 0) == 0) return name.substr(prefix.size());
  }
  return name;
}

// The parts of "imu/gyro".
std::pair<std::string, std::string> GroupAndName(const std::string& array) {
  const std::size_t slash = array.rfind('/');
  if (slash == std::string::npos) return {"", array};
  return {array.substr(0, slash), array.substr(slash + 1)};
}

std::vector<std::string> ArraysOf(const std::string& path) {
  return IsNpz(path) ? NamesInNpz(path) : std::vector<std::string>{""};
}

std::optional<NpyHeader> HeaderOf(const std::string& path, const std::string& array) {
  try {
    return ReadNpyHeader(Open(path, array).get());
  } catch (const std::runtime_error&) {
    return {};  // a single number, or text
  }
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
    std::optional<NpyHeader> header = HeaderOf(path, array);
    if (!header) continue;
    if (!header->one_dimension) {
      tables.push_back(TableOf(path, array, *header));
      continue;
    }
    const auto [group, name] = GroupAndName(array);
    header->columns.front().name =
        WithoutPrefix(name, {"events_", "event_", "ev_"}) + header->columns.front().name;
    NpyTable& table = groups.try_emplace(group, NpyTable{path, group, 0, {}}).first->second;
    // Events are the longest arrays; others count for something else.
    if (header->rows > table.rows) table.columns.clear();
    if (header->rows < table.rows) continue;
    table.rows = header->rows;
    table.columns.push_back({array, false, header->columns.front()});
  }
  for (auto& [name, table] : groups) tables.push_back(std::move(table));
  return tables;
}

std::vector<NpyTable> FindNpyImuTables(const std::string& path) {
  std::vector<NpyTable> whole;
  std::map<std::pair<std::string, std::uint64_t>, NpyTable> groups;  // by part and length
  for (const std::string& array : ArraysOf(path)) {
    const std::optional<NpyHeader> header = HeaderOf(path, array);
    if (!header) continue;
    const std::size_t n = header->columns.size();
    if (n >= 7) whole.push_back(TableOf(path, array, *header));
    if (n != 1 && n != 3 && n != 6) continue;
    const auto [group, array_name] = GroupAndName(array);
    const std::string name = WithoutPrefix(array_name, {"imu_", "imu0_"});
    NpyTable& table =
        groups.try_emplace({group, header->rows}, NpyTable{path, group, header->rows, {}}).first->second;
    for (std::size_t k = 0; k < n; ++k) {
      NpyColumn column = header->columns[k];
      if (n == 1) column.name = name + column.name;
      if (n == 3) column.name = name + "_" + "xyz"[k];
      const NpyTable::Column placed{array, header->by_column, column};
      // The stamp comes first, as in a table without names.
      table.columns.insert(n == 1 ? table.columns.begin() : table.columns.end(), placed);
    }
  }
  for (auto& [key, table] : groups) {
    if (table.columns.size() >= 7) whole.push_back(std::move(table));
  }
  return whole;
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
