#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evit::formats {

/// Prophesee's events, which are compounds.
struct H5Event {
  std::uint16_t x, y;
  std::int16_t p;
  std::int64_t t;
};

/// A dataset of rows of numbers, which may stand across (MATLAB's). Says what its numbers are, so that nobody
/// converts what should be refused.
class H5Rows {
 public:
  /// Of `path`, which `file` keeps open; `member`: of the compounds that the dataset is made of, else empty.
  /// Throws std::runtime_error naming file and dataset where there is none such.
  H5Rows(std::shared_ptr<void> file, const std::string& path, const std::string& dataset,
         const std::string& member);

  const std::string& name() const;
  std::size_t rows() const;
  std::size_t columns() const;     // numbers in a row: all other dimensions
  std::size_t chunk_rows() const;  // rows that are compressed together; at least 1
  bool is_number() const;          // whole numbers (bool too) or floats
  bool is_integer() const;
  bool is_signed() const;
  bool is_compound() const;
  std::vector<std::string> members() const;     // of a compound, by their names
  std::size_t bytes() const;                    // of one number
  std::optional<std::uint64_t> stored() const;  // bytes in the file; none where they are in other files

  /// Rows [begin, begin + n) as ..., of all columns; throws std::runtime_error naming file and dataset, with
  /// the remedy where a filter is missing. Number: uint8_t, uint16_t, int64_t, double.
  template <typename Number>
  void Read(std::size_t begin, std::size_t n, std::vector<Number>* out) const;
  template <typename Number>
  std::vector<Number> ReadAll() const;
  /// The same of compounds x, y, p, t.
  void ReadEvents(std::size_t begin, std::size_t n, std::vector<H5Event>* out) const;

  [[noreturn]] void Fail(const std::string& what) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace evit::formats
