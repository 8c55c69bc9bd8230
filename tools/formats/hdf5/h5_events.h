#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/events/event.h"
#include "tools/formats/hdf5/h5_event_layout.h"
#include "tools/formats/hdf5/h5_file.h"
#include "tools/formats/hdf5/h5_stamps.h"
#include "tools/formats/import/event_columns.h"
#include "tools/formats/import/polarity_code.h"

namespace evit::formats {

/// Reads events of any such layout in pieces. What a number means is checked, not assumed: whole pixels,
/// polarities 0/1 or -1/1; the unit of the stamps and the order of rows as in text (FindEventColumns). Throws
/// std::runtime_error naming file and dataset.
class H5EventReader {
 public:
  H5EventReader(const H5File& file, const H5EventLayout& layout);

  /// Replaces `events` by the next ones; false at the end. Pixels that do not fit 16 bits become 65535;
  /// events whose stamp is not a time are left out and counted.
  bool Read(EventArray* events);
  double share() const { return size_ > 0 ? static_cast<double>(at_) / static_cast<double>(size_) : 1; }
  std::int64_t n_invalid() const { return n_invalid_; }

 private:
  struct Columns {
    H5Rows x, y, p;
  };

  void ReadPixels(const H5Rows& rows, std::size_t n, std::vector<std::uint16_t>* out);
  void ReadTimes(std::size_t n, std::vector<Utime>* out);
  void ReadPolarities(const H5Rows& rows, std::size_t n, std::vector<std::uint8_t>* out);
  void ReadRows(std::size_t n, EventArray* events);
  void ReadCompounds(std::size_t n, EventArray* events);
  std::uint8_t Polarity(const H5Rows& rows, double value);
  std::uint16_t Pixel(const H5Rows& rows, double value) const;
  void DropUntimed(EventArray* events);

  H5EventLayout::Kind kind_;
  std::optional<Columns> columns_;
  H5Rows t_;
  EventColumns order_;  // of rows; the unit of all
  std::optional<H5Stamps> stamps_;
  std::size_t size_ = 0, at_ = 0, piece_ = 0;
  PolarityCode polarity_;
  std::vector<double> doubles_;
  std::int64_t n_invalid_ = 0;
};

}  // namespace evit::formats
