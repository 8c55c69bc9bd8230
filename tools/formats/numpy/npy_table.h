#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/files/table_sample.h"
#include "tools/formats/numpy/npy_header.h"

namespace evit::formats {

/// Columns of one length in numpy's files: those of one array, or arrays of one dimension in an archive.
struct NpyTable {
  struct Column {
    std::string array;  // in the archive; empty: the file itself
    bool by_column = false;
    NpyColumn numbers;
  };
  std::string path;
  std::string name;  // of the array, or what the names of the arrays begin with, up to the slash
  std::uint64_t rows = 0;
  std::vector<Column> columns;
};

/// The tables of a file (.npy) or an archive (.npz); arrays without numbers in rows are passed over in the
/// latter. Throws std::runtime_error naming the file where it is damaged.
std::vector<NpyTable> FindNpyTables(const std::string& path);

/// What may be the IMU's among the arrays: of rows of seven numbers and more, first; then arrays of one
/// length and one part of the archive, with a stamp and three or six numbers a row, named x, y and z where
/// three.
std::vector<NpyTable> FindNpyImuTables(const std::string& path);

/// The first rows of a table as text has them.
TableSample SampleNpy(const NpyTable& table);

/// Reads a table from its first row to its last.
class NpyRows {
 public:
  explicit NpyRows(const NpyTable& table);
  /// The next rows, `n` at most; returns how many, 0 at the end.
  std::uint64_t Read(std::uint64_t n);
  /// Where a number of the rows read stands.
  const std::uint8_t* At(std::size_t column, std::uint64_t row) const {
    const Place& place = places_[column];
    return streams_[place.stream].data + row * streams_[place.stream].stride + place.offset;
  }
  double share() const { return rows_ > 0 ? 1 - static_cast<double>(left_) / static_cast<double>(rows_) : 1; }

 private:
  struct Stream {
    std::unique_ptr<NpyInput> input;
    std::uint64_t stride = 0;
    const std::uint8_t* data = nullptr;
  };
  struct Place {
    std::size_t stream = 0;
    std::uint64_t offset = 0;
  };

  std::vector<Stream> streams_;
  std::vector<Place> places_;
  std::uint64_t rows_, left_;
};

}  // namespace evit::formats
