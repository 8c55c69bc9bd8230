#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/files/decimal_time.h"
#include "tools/formats/numpy/npy_input.h"

namespace evit::formats {

/// One column of numbers of an array, and where its values stand.
struct NpyColumn {
  std::string name;  // of a structured array's field, with the unit of a date in brackets; empty: it has none
  char kind = 'i';   // i, u, f, b
  int bytes = 0;
  bool big_endian = false;
  std::uint64_t begin = 0, stride = 0;  // bytes from the first number of the array on
};

/// The header of numpy's file format (NEP 1, versions 1.0 to 3.0).
struct NpyHeader {
  std::uint64_t rows = 0;
  bool one_dimension = false;  // one number a row, without a name
  bool by_column = false;      // each column by itself, one after the other; else row by row
  std::vector<NpyColumn> columns;
};

/// Whether the file is one of numpy's arrays.
bool IsNpy(const std::string& path);

/// Reads the header of an array of one dimension, of rows of numbers, of columns (4 x N, or in Fortran's
/// order), or of structures. Throws std::runtime_error naming file and remedy where its rows have no numbers,
/// or there are fewer than it says.
NpyHeader ReadNpyHeader(NpyInput* input);

/// A number of a row; whole numbers exactly (NpyInteger) where they are.
std::int64_t NpyInteger(const NpyColumn& column, const std::uint8_t* at);
double NpyNumber(const NpyColumn& column, const std::uint8_t* at);
/// A stamp of this unit in us, rounded; false where it is not finite, or beyond any date.
bool NpyTime(const NpyColumn& column, const std::uint8_t* at, TimeUnit unit, Utime* t);

}  // namespace evit::formats
