#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se3.h"

namespace evit {

/// One field of a PCD's rows.
struct PcdField {
  std::string name;
  std::size_t size = 4, count = 1, offset = 0;  // bytes of one value, values, bytes from the row's begin
  char type = 'F';                              // float, I signed, U unsigned
};

/// The head of a PCD file, versions .5 to .7 (FIELDS was COLUMNS once; POINTS and VIEWPOINT came later).
struct PcdHeader {
  std::vector<PcdField> fields;
  std::optional<std::uint64_t> points;  // POINTS
  std::optional<std::uint64_t> cells;   // WIDTH x HEIGHT
  std::size_t stride = 0, end = 0;      // bytes of a row; first byte of the data
  std::string data;                     // ascii, binary or binary_compressed
  SE3 viewpoint;                        // the points are to be moved by this

  bool moved() const { return !viewpoint.p.isZero() || !viewpoint.q.vec().isZero(); }
  /// How many points there are, by whichever of POINTS and WIDTH x HEIGHT the data agrees with. `rows`: how
  /// many the data holds, where that is exact. Throws std::runtime_error where both disagree with it.
  std::size_t Count(std::optional<std::uint64_t> rows) const;
};

/// Throws std::runtime_error with what is wrong.
PcdHeader ReadPcdHeader(const std::string& bytes);

}  // namespace evit
