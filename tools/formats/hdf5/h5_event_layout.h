#pragma once

#include <string>
#include <vector>

#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {

/// Where a file holds its events: one dataset per number (x, y, t, p; also the members of any compound), one
/// of rows of four, or Prophesee's compounds.
struct H5EventLayout {
  enum class Kind { kColumns, kRows, kCompound };

  Kind kind = Kind::kColumns;
  std::string group;       // of the columns, with a slash at its end; "" for the root
  std::string x, y, t, p;  // datasets of columns; `t` alone for rows and compounds
  std::string offset;      // dataset with what is to be added to each stamp, us; empty: none
};

/// All places in a file that hold events.
std::vector<H5EventLayout> FindEvents(const H5File& file);

}  // namespace evit::formats
