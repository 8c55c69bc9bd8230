#include "tools/formats/numpy/npy_header.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <regex>

#include "tools/formats/import/latest_time.h"
#include "tools/formats/import/micros_per_unit.h"

namespace evit::formats {
namespace {

constexpr char kMagic[] = "\x93NUMPY";
constexpr std::size_t kMagicSize = 6;
constexpr std::uint32_t kMaxHeader = 1 << 16;
constexpr std::size_t kMaxColumns = 64;
constexpr int kMaxDigits = 15;

template <typename T>
T As(const std::uint8_t* data, bool big_endian) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, data, sizeof(T));
  if (big_endian) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

// "<i8", "|b1", ">f4", "<M8[us]" (a date); bytes without a meaning, "|V3", have kind 'V'.
NpyColumn ParseType(const NpyInput& input, const std::string& name, const std::string& type) {
  static const std::regex kType(R"(([<>|=]?)([iufb])([1248]))"), kDate(R"(([<>|=]?)[mM]8\[(s|ms|us|ns)\])"),
      kPadding(R"(\|V([0-9]{1,6}))");
  std::smatch match;
  NpyColumn column;
  column.name = name;
  if (std::regex_match(type, match, kDate)) {
    column.name += "[" + match[2].str() + "]";
    column.bytes = 8;
    column.big_endian = match[1] == ">";
    return column;
  }
  if (std::regex_match(type, match, kPadding)) {
    column.kind = 'V';
    column.bytes = std::stoi(match[1]);
    return column;
  }
  if (!std::regex_match(type, match, kType) || (match[2] == "f" && (match[3] == "1" || match[3] == "2")) ||
      (match[2] == "b" && match[3] != "1"))
    input.Fail("the array's type " + type + " is not read; save it as integers or floats: a.astype(...)");
  column.kind = match[2].str()[0];
  column.bytes = std::stoi(match[3]);
  column.big_endian = match[1] == ">";
  return column;
}

std::vector<std::uint64_t> Numbers(const NpyInput& input, const std::string& text) {
  static const std::regex kNumber("[0-9]+");
  std::vector<std::uint64_t> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), kNumber); at != std::sregex_iterator(); ++at) {
    if (at->length() > kMaxDigits) input.Fail("the header's shape cannot be an array's: it is damaged");
    numbers.push_back(std::stoull(at->str()));
  }
  return numbers;
}

std::vector<std::uint64_t> ParseShape(const NpyInput& input, const std::string& text) {
  static const std::regex kShape(R"('shape'\s*:\s*\(([0-9L, ]*)\))");
  std::smatch match;
  if (!std::regex_search(text, match, kShape)) input.Fail("the header says no shape: it is damaged");
  return Numbers(input, match[1]);
}

// "('t', '<i8'), ('x', '<u2'), ('', '|V3')" and so on; fields that are arrays themselves are passed over.
void ParseFields(const NpyInput& input, std::string text, NpyHeader* header) {
  static const std::regex kField(R"(\(\s*'([^']*)'\s*,\s*'([^']*)'\s*(,\s*\(([0-9, ]*)\)\s*)?\))");
  std::uint64_t offset = 0;
  std::smatch match;
  std::size_t n = 0;
  for (; std::regex_search(text, match, kField); text = match.suffix()) {
    if (++n > kMaxColumns) input.Fail("the array has too many fields for one of events");
    if (match.prefix().str().find('\'') != std::string::npos)
      input.Fail("has fields in fields; save a plain structured array");
    NpyColumn column = ParseType(input, match[1], match[2]);
    std::uint64_t bytes = static_cast<std::uint64_t>(column.bytes);
    for (const std::uint64_t times : Numbers(input, match[4]))
      bytes = std::min<std::uint64_t>(bytes * times, kMaxHeader);
    column.begin = offset;
    offset += bytes;
    if (column.kind != 'V' && !match[3].matched) header->columns.push_back(column);
  }
  if (text.find('\'') != std::string::npos) input.Fail("has fields in fields; save a plain structured array");
  for (NpyColumn& column : header->columns) column.stride = offset;
}

// Rows of numbers; four rows (or columns in Fortran's order) are columns that stand one after the other.
void PutNumbers(const NpyInput& input, const std::string& type, std::vector<std::uint64_t>* shape,
                bool fortran, NpyHeader* header) {
  const NpyColumn one = ParseType(input, "", type);
  const auto bytes = static_cast<std::uint64_t>(one.bytes);
  if (one.kind == 'V' || shape->empty() || shape->size() > 2)
    input.Fail("expected rows of numbers (N x 4), or a structured array with t, x, y and p");
  header->one_dimension = shape->size() == 1;
  std::uint64_t columns = header->one_dimension ? 1 : (*shape)[1];
  const bool transposed = columns != 4 && (*shape)[0] == 4 && !header->one_dimension && columns > 4;
  if (transposed) std::swap((*shape)[0], columns);
  header->by_column = !header->one_dimension && fortran != transposed;
  if (columns < 1 || columns > kMaxColumns)
    input.Fail("expected rows of numbers (N x 4), or a structured array with t, x, y and p");
  for (std::uint64_t k = 0; k < columns; ++k) {
    header->columns.push_back(one);
    header->columns.back().begin = k * bytes * (header->by_column ? (*shape)[0] : 1);
    header->columns.back().stride = bytes * (header->by_column ? 1 : columns);
  }
}

}  // namespace

bool IsNpy(const std::string& path) {
  char magic[kMagicSize] = {};
  std::ifstream file(path, std::ios::binary);
  return file.read(magic, kMagicSize) && std::memcmp(magic, kMagic, kMagicSize) == 0;
}

NpyHeader ReadNpyHeader(NpyInput* input) {
  const std::uint8_t* begin = input->Take(8);
  if (std::memcmp(begin, kMagic, kMagicSize) != 0) input->Fail("is not a numpy array");
  const bool long_size = begin[6] >= 2;
  const std::uint8_t* bytes = input->Take(long_size ? 4 : 2);
  const std::uint32_t size = long_size ? As<std::uint32_t>(bytes, false) : As<std::uint16_t>(bytes, false);
  if (size > kMaxHeader) input->Fail("the header is too long: it is damaged");
  const std::string text(reinterpret_cast<const char*>(input->Take(size)), size);
  static const std::regex kFortran(R"('fortran_order'\s*:\s*True)"), kPlain(R"('descr'\s*:\s*'([^']*)')");
  NpyHeader header;
  std::vector<std::uint64_t> shape = ParseShape(*input, text);
  std::smatch match;
  if (std::regex_search(text, match, kPlain)) {
    PutNumbers(*input, match[1], &shape, std::regex_search(text, kFortran), &header);
  } else if (std::size_t at = text.find("'descr'"), end = text.find("'fortran_order'");
             at != std::string::npos && end != std::string::npos && at < end && shape.size() == 1) {
    at = std::min(text.find(':', at) + 1, end);
    ParseFields(*input, text.substr(at, end - at), &header);
  } else {
    input->Fail("expected rows of numbers (N x 4), or a structured array with t, x, y and p");
  }
  if (header.columns.empty()) input->Fail("has no field that is a number");
  header.rows = shape[0];
  const std::uint64_t row_bytes = header.by_column ? header.columns.front().stride * header.columns.size()
                                                   : header.columns.front().stride;
  if (row_bytes == 0 || header.rows > input->left() / row_bytes)
    input->Fail("holds fewer rows than it says: it is cut off; copy it again");
  return header;
}

std::int64_t NpyInteger(const NpyColumn& column, const std::uint8_t* at) {
  const bool is_signed = column.kind == 'i', swap = column.big_endian;
  switch (column.bytes) {
    case 1:
      return is_signed ? As<std::int8_t>(at, swap) : std::int64_t{*at};
    case 2:
      return is_signed ? As<std::int16_t>(at, swap) : std::int64_t{As<std::uint16_t>(at, swap)};
    case 4:
      return is_signed ? As<std::int32_t>(at, swap) : std::int64_t{As<std::uint32_t>(at, swap)};
    default:
      return As<std::int64_t>(at, swap);
  }
}

double NpyNumber(const NpyColumn& column, const std::uint8_t* at) {
  if (column.kind != 'f') return static_cast<double>(NpyInteger(column, at));
  return column.bytes == 4 ? static_cast<double>(As<float>(at, column.big_endian))
                           : As<double>(at, column.big_endian);
}

bool NpyTime(const NpyColumn& column, const std::uint8_t* at, TimeUnit unit, Utime* t) {
  // Whole numbers of other units are dates in ns at most, which a long double holds.
  const long double number = column.kind != 'f' ? static_cast<long double>(NpyInteger(column, at))
                                                : static_cast<long double>(NpyNumber(column, at));
  const long double value = static_cast<long double>(MicrosPerUnit(unit)) * number;
  if (!(std::abs(value) < kLatestTime)) return false;
  *t = std::llround(value);
  return true;
}

}  // namespace evit::formats
