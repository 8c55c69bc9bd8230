#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/files/decimal_time.h"

namespace evit {

/// The beginning of a table, read ahead to tell which columns and units it has.
struct TableSample {
  std::vector<std::string> head;               // names of the columns; empty where there are none
  std::vector<std::vector<std::string>> rows;  // the words of the first rows
};

/// Up to `max_rows` rows. Throws as TableReader does.
TableSample SampleTable(const std::string& path, const std::string& layout, std::size_t max_rows = 1000);

/// A column's name and the unit behind it: "timestamp [ns]", "w_x[rad s^-1]", "time (ms)".
struct ColumnName {
  std::string name, unit;
};

/// The words of a head as columns: what stands in brackets belongs to the name before it.
std::vector<ColumnName> NamedColumns(const std::vector<std::string>& head);

/// The unit that a column's name says: "timestamp [ns]", "t_us", "time(ms)", "t[s]". Nothing where it says
/// none.
std::optional<TimeUnit> UnitInName(const ColumnName& name);

/// The unit of a column of stamps: what the head says, else what the number of digits of a date says; for
/// whole numbers that count from zero, microseconds or nanoseconds where the rows would otherwise be more
/// than `slowest_s` seconds apart, or mostly at the same second; for events (rows closer than 10 ms),
/// milliseconds where there are three decimals, nanoseconds where all end in three zeros. Seconds where
/// nothing speaks against it.
TimeUnit UnitOfStamps(const TableSample& sample, std::size_t column, double slowest_s);

}  // namespace evit
