#pragma once

#include <array>
#include <cstddef>

#include "common/files/table_reader.h"
#include "common/files/table_sample.h"

namespace evit {

/// Where a table of poses has its columns.
struct PoseColumns {
  static constexpr std::size_t kNone = -1;  // no column

  std::size_t time = 0;
  std::size_t nanoseconds = kNone;                        // beside whole seconds in `time`
  std::array<std::size_t, 3> position = {1, 2, 3};        // x y z
  std::array<std::size_t, 4> orientation = {4, 5, 6, 7};  // x y z w
};

/// As the head names them, e.g. "tx ... qw", EuRoC's "p_RS_R_x [m] ... q_RS_w []" (w first), and
/// "field.pose.position.x ..." of `rostopic echo -p`; the TUM format's order where there is no head, or one
/// that does not name all eight.
PoseColumns PoseColumnsOf(const TableSample& sample);

/// The unit of the stamps: as UnitOfStamps, and seconds where nanoseconds stand beside them. `slowest_s`:
/// poses are no further apart.
TimeUnit UnitOfPoses(const TableSample& sample, const PoseColumns& columns, double slowest_s);

/// Whether rows without names are a stamp and a 3x4 or 4x4 matrix, which eight columns of them would not be.
bool HoldsMatrices(const TableSample& sample);

struct PoseRow {
  bool timed = false;  // the time is finite
  Utime t = 0;
  std::array<double, 3> position{};     // not checked: may be nan
  std::array<double, 4> orientation{};  // x y z w, of any length
};

/// The row that `table` stands at, as far as its last column of a pose. Throws as TableReader does.
PoseRow ReadPoseRow(const PoseColumns& columns, TimeUnit unit, TableReader* table);

}  // namespace evit
