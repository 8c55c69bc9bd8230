#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evit::formats {

/// A dataset of rows of numbers, which may stand across (MATLAB's). Says what its numbers are, so that nobody
/// converts what should be refused.
class H5Rows {
 public:
  struct Impl;
  explicit H5Rows(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

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

  [[noreturn]] void Fail(const std::string& what) const;

 private:
  friend class H5File;
  std::shared_ptr<const Impl> impl_;
};

/// Prophesee's events, which are compounds.
struct H5Event {
  std::uint16_t x, y;
  std::int16_t p;
  std::int64_t t;
};

/// An HDF5 file that is read.
class H5File {
 public:
  static bool Recognises(const std::string& path);

  /// Throws std::runtime_error naming the file where it is not whole.
  explicit H5File(const std::string& path);
  bool Has(const std::string& name) const;
  /// A dataset, or one member of compounds: DATASET:MEMBER. Throws where there is no such.
  H5Rows Open(const std::string& requested) const;
  /// All datasets, by their paths ("events/x").
  const std::vector<std::string>& datasets() const { return datasets_; }
  /// A text of the file itself (attribute); empty where there is none.
  std::string Attribute(const std::string& name) const;
  /// A dataset that is one text; empty where there is none.
  std::string Text(const std::string& name) const;
  const std::string& path() const { return path_; }

  static void ReadEvents(const H5Rows& rows, std::size_t begin, std::size_t n, std::vector<H5Event>* out);

 private:
  std::string path_;
  std::shared_ptr<void> file_;
  std::vector<std::string> datasets_;
};

}  // namespace evit::formats
