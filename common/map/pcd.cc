#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "common/files/table_reader.h"
#include "common/map/map_formats.h"
#include "common/map/pcd_header.h"

namespace evit {
namespace {

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

using Axes = std::array<const PcdField*, 3>;

const PcdField& Find(const PcdHeader& header, const char* name) {
  const auto it = std::find_if(header.fields.begin(), header.fields.end(),
                               [&](const PcdField& f) { return f.name == name; });
  if (it == header.fields.end()) Fail(std::string("FIELDS has no ") + name);
  const bool real = it->type == 'F' && (it->size == 4 || it->size == 8);
  const bool whole = (it->type == 'I' || it->type == 'U') &&
                     (it->size == 1 || it->size == 2 || it->size == 4 || it->size == 8);
  if (!real && !whole) {
    Fail(std::string("field ") + name + ": TYPE " + it->type + " of SIZE " + std::to_string(it->size) +
         " is not known; expected F of 4 or 8, I or U of 1, 2, 4 or 8");
  }
  if (it->count != 1) Fail(std::string("field ") + name + " has a COUNT other than 1");
  return *it;
}

template <typename T>
double As(const char* data) {
  T v;
  std::memcpy(&v, data, sizeof v);
  return static_cast<double>(v);
}

double Load(const char* data, const PcdField& field) {
  if (field.type == 'F') return field.size == 8 ? As<double>(data) : As<float>(data);
  const bool sign = field.type == 'I';
  switch (field.size) {
    case 1:
      return sign ? As<std::int8_t>(data) : As<std::uint8_t>(data);
    case 2:
      return sign ? As<std::int16_t>(data) : As<std::uint16_t>(data);
    case 4:
      return sign ? As<std::int32_t>(data) : As<std::uint32_t>(data);
    default:
      return sign ? As<std::int64_t>(data) : As<std::uint64_t>(data);
  }
}

// Where x, y and z stand in a row of text, and how many values it has.
std::array<std::size_t, 4> Columns(const PcdHeader& header, const Axes& axes) {
  std::array<std::size_t, 4> columns{};
  for (const PcdField& field : header.fields) {
    for (int k = 0; k < 3; ++k) {
      if (&field == axes[k]) columns[k] = columns[3];
    }
    columns[3] += field.count;
  }
  return columns;
}

void ReadAscii(const PcdHeader& header, const Axes& axes, const std::string& bytes, CloudPoints* points) {
  const auto columns = Columns(header, axes);
  const std::size_t needed = 1 + *std::max_element(columns.begin(), columns.begin() + 3);
  TableReader rows(std::string_view(bytes).substr(header.end), "data",
                   "the " + std::to_string(columns[3]) + " FIELDS");
  while (rows.Next()) {
    Eigen::Vector3d p;
    for (std::size_t k = 0; k < needed; ++k) {
      const auto axis = std::find(columns.begin(), columns.begin() + 3, k);
      if (axis == columns.begin() + 3) {
        rows.Word();
      } else {
        p[axis - columns.begin()] = rows.Number();
      }
    }
    points->push_back(p);
  }
  const std::size_t n = header.Count(points->size());
  if (points->size() != n) {
    Fail((points->size() < n ? "truncated: " : "POINTS or WIDTH is wrong: ") + std::to_string(n) +
         " points announced, " + std::to_string(points->size()) + " found");
  }
}

[[noreturn]] void FailTruncated(std::size_t n, std::size_t needed, std::size_t available) {
  Fail("truncated: " + std::to_string(n) + " points need " + std::to_string(needed) + " bytes of data, " +
       std::to_string(available) + " are there; copy the file again");
}

void ReadBinary(const PcdHeader& header, const Axes& axes, const std::string& bytes, CloudPoints* points) {
  const std::size_t available = bytes.size() - header.end;
  const std::size_t n = header.Count(available / header.stride);
  if (n * header.stride > available) FailTruncated(n, n * header.stride, available);
  points->reserve(n);
  const char* row = bytes.data() + header.end;
  for (std::size_t k = 0; k < n; ++k, row += header.stride) {
    points->emplace_back(Load(row + axes[0]->offset, *axes[0]), Load(row + axes[1]->offset, *axes[1]),
                         Load(row + axes[2]->offset, *axes[2]));
  }
}

void ReadCompressed(const PcdHeader& header, const Axes& axes, const std::string& bytes,
                    CloudPoints* points) {
  const std::size_t available = bytes.size() - header.end;
  std::uint32_t sizes[2];  // compressed, uncompressed
  if (available < sizeof sizes) FailTruncated(header.points.value_or(0), sizeof sizes, available);
  std::memcpy(sizes, bytes.data() + header.end, sizeof sizes);
  const std::size_t n = header.Count(sizes[1] / header.stride);
  if (sizes[0] > available - sizeof sizes) FailTruncated(n, sizes[0] + sizeof sizes, available);
  if (sizes[1] != n * header.stride)
    Fail("the uncompressed size in the file does not agree with POINTS and FIELDS");
  if (sizes[1] / 300 > sizes[0]) Fail("the compressed size is absurd");  // LZF packs 264 : 1 at the very best
  std::vector<char> raw(sizes[1]);
  if (!DecompressLzf(reinterpret_cast<const std::uint8_t*>(bytes.data() + header.end + sizeof sizes),
                     sizes[0], reinterpret_cast<std::uint8_t*>(raw.data()), raw.size())) {
    Fail("the compressed data is damaged; copy or export the file again");
  }
  points->reserve(n);
  for (std::size_t k = 0; k < n; ++k) {  // field by field: all x, then all y, ...
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const PcdField& f = *axes[axis];
      p[axis] = Load(raw.data() + f.offset * n + k * f.size * f.count, f);
    }
    points->push_back(p);
  }
}

}  // namespace

void ReadPcd(const std::string& bytes, CloudPoints* points, std::string* format) {
  const PcdHeader header = ReadPcdHeader(bytes);
  const Axes axes = {&Find(header, "x"), &Find(header, "y"), &Find(header, "z")};
  *format = "PCD " + header.data + (header.moved() ? ", moved by its VIEWPOINT" : "");
  if (header.data == "ascii") {
    ReadAscii(header, axes, bytes, points);
  } else if (header.data == "binary") {
    ReadBinary(header, axes, bytes, points);
  } else if (header.data == "binary_compressed") {
    ReadCompressed(header, axes, bytes, points);
  } else {
    Fail("DATA \"" + header.data + "\" is not known; expected ascii, binary or binary_compressed");
  }
  if (!header.moved()) return;
  for (Eigen::Vector3d& p : *points) p = header.viewpoint * p;
}

}  // namespace evit
