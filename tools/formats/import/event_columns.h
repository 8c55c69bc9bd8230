#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/files/table_sample.h"

namespace evit::formats {

/// Which column of a text file of events is which, in which unit the stamps are, and how large the sensor is.
struct EventColumns {
  /// kNanoseconds: a column of its own, beside whole seconds in kTime.
  enum Field { kTime, kX, kY, kPolarity, kNanoseconds, kIgnored };
  std::array<Field, 16> field = {kTime, kX, kY, kPolarity};  // the first n count
  std::size_t n = 4;
  TimeUnit unit = TimeUnit::kSeconds;
  std::optional<std::pair<int, int>> size;  // of a first line "width height", which is to be passed over
};

/// Told from the names of the columns, else from the values: polarities are few, pixels small and whole,
/// times do not go back. "t x y p" where nothing speaks against it. Throws std::runtime_error naming the file
/// where the names or the number of columns are not those of events.
EventColumns FindEventColumns(const std::string& path);
/// The same of rows that were read already.
EventColumns FindEventColumns(TableSample sample);

/// Whether a head names all four of them.
bool NamesEvents(const std::vector<std::string>& head);

/// Whether rows of four numbers without names can be events, in any order.
bool FitsEvents(const TableSample& sample);

/// Whether a table may be one of events: four columns of numbers (polarities may be words), below a line
/// "width height" or not; or names of the columns that say so.
bool HoldsEvents(TableSample sample);

}  // namespace evit::formats
