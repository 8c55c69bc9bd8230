#pragma once

#include <string>

namespace evit::formats {

/// What a file of a recording may hold. kBag: of ROS; kEvents: another file of events; kStreams: HDF5 with
/// IMU or truth alone; the others are text tables.
enum class FileKind { kNone, kBag, kH5Events, kEvents, kStreams, kEventTable, kImuTable, kPoseTable };

/// By its contents, whatever its name. Throws std::runtime_error naming the file where it is one of these,
/// but damaged.
FileKind KindOfFile(const std::string& path);

}  // namespace evit::formats
