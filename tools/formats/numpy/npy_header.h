#pragma once

#include <string>
#include <vector>

#include "tools/formats/import/byte_file.h"

namespace evit::formats {

/// What a numpy file (.npy, format 1 to 3) says of its array: rows of numbers, each at its place in a row.
struct NpyHeader {
  struct Field {
    std::string name;  // empty in an array that is not structured
    char kind;         // as numpy says it: 'i', 'u', 'f', 'b'
    int bytes;
    std::size_t offset;  // in a row
  };
  std::vector<Field> fields;
  std::size_t row_bytes = 0;
  std::uint64_t rows = 0;
};

bool IsNpy(const std::string& path);

/// Reads it from the front of a file, up to the first row. Throws std::runtime_error naming the file: not
/// little-endian, column-wise (Fortran), objects, more than two dimensions, or fewer bytes than rows.
NpyHeader ReadNpyHeader(ByteFile* file);

/// A number of a row.
double NpyNumber(const NpyHeader::Field& field, const std::uint8_t* row);
/// One that is no float.
std::int64_t NpyInteger(const NpyHeader::Field& field, const std::uint8_t* row);

}  // namespace evit::formats
