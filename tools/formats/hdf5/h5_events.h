#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/events/event.h"
#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {

/// Where a file holds its events: one dataset per number (x, y, t, p), one of rows x y t p (MVSEC), or
/// Prophesee's compounds.
struct H5EventLayout {
  enum class Kind { kColumns, kRows, kCompound };

  Kind kind = Kind::kColumns;
  std::string group;       // of the columns, with a slash at its end; "" for the root
  std::string x, y, t, p;  // datasets of columns; `t` alone for rows and compounds
  std::string offset;      // dataset with what is to be added to each stamp, us; empty: none
};

/// All places in a file that hold events.
std::vector<H5EventLayout> FindEvents(const H5File& file);

/// Reads events of any such layout in pieces. What a number means is checked, not assumed: whole pixels,
/// polarities 0/1 or -1/1, stamps as whole microseconds or as seconds with fractions. Throws
/// std::runtime_error naming file and dataset.
class H5EventReader {
 public:
  H5EventReader(const H5File& file, const H5EventLayout& layout);

  /// Replaces `events` by the next ones; false at the end. Pixels that do not fit 16 bits become 65535.
  bool Read(EventArray* events);
  double share() const { return size_ > 0 ? static_cast<double>(at_) / static_cast<double>(size_) : 1; }

 private:
  void ReadPixels(const H5Rows& rows, std::size_t n, std::vector<std::uint16_t>* out);
  void ReadTimes(std::size_t n, std::vector<Utime>* out);
  void ReadPolarities(std::size_t n, std::vector<std::uint8_t>* out);
  void ReadRows(std::size_t n, EventArray* events);
  void ReadCompounds(std::size_t n, EventArray* events);
  std::uint8_t Polarity(const H5Rows& rows, double value);
  std::uint16_t Pixel(const H5Rows& rows, double value) const;

  H5EventLayout::Kind kind_;
  std::optional<H5Rows> x_, y_, p_;
  H5Rows t_;
  Utime offset_ = 0;
  bool seconds_ = false;
  std::size_t size_ = 0, at_ = 0, piece_ = 0;
  bool zero_seen_ = false, minus_seen_ = false;
  std::vector<double> doubles_;
};

}  // namespace evit::formats
