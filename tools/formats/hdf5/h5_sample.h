#pragma once

#include <string>
#include <vector>

#include "common/files/table_sample.h"
#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {

/// The first rows of columns of one length (or of one table) as text has them, from which units and order are
/// told. `head`: the names of the columns, between gaps; may be empty.
TableSample SampleColumns(const std::vector<const H5Rows*>& columns, const std::string& head);

}  // namespace evit::formats
