#pragma once

#include <filesystem>
#include <string>

namespace evit::formats {

/// The file that `ros2 bag` writes beside the parts of a bag, and lists them in.
inline constexpr char kBagMetadata[] = "metadata.yaml";

/// Whether a text is its first part.
bool IsBagMetadata(const std::string& begin);

/// Throws std::runtime_error with the remedy where a file is compressed as a whole (ros2 bag record
/// --compression-mode file), and not unpacked beside it either.
void RefusePackedPart(const std::filesystem::path& file);

/// Throws std::runtime_error naming the first file that is listed and not there: the bag would have a hole.
/// Passes where the folder has no such list.
void RequireListedParts(const std::string& folder);

}  // namespace evit::formats
