#pragma once

#include <string>

namespace evit::formats {

enum class TableKind { kNone, kEvents, kImu, kPoses };

/// What a text file is a table of, from the names of its columns and from its values: poses have a
/// quaternion of length 1, and of what else has a stamp and six numbers an IMU's are expected. kNone: no
/// text, no table, or one of something else.
TableKind KindOfTable(const std::string& path);

}  // namespace evit::formats
