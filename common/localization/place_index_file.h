#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/localization/place_index.h"

/// An index of places kept in a file beside its map, so that it is made once.
namespace evit {

/// Of all that an index depends on: the points, the options, and how this version makes it.
std::uint64_t FingerprintOf(const PointMap& map, const PlaceIndexOptions& options);

/// None: there is no such file, it is of another map, other options or another version, or it is damaged.
std::optional<PlaceIndex> ReadPlaceIndex(const std::string& path, std::uint64_t fingerprint);

/// The file appears when it is complete. False where it cannot be written, as beside a map that was installed
/// for all users: no harm, the next one makes its own.
bool WritePlaceIndex(const std::string& path, std::uint64_t fingerprint, const PlaceIndex& index);

/// From the file where it fits the map; else made, and kept there. `path` empty: made, not kept. `progress`:
/// PlaceIndex's; not called where the file was read. `read`, where not null: whether it was.
PlaceIndex ReadOrMakePlaceIndex(const std::string& path, const PointMap& map,
                                const PlaceIndexOptions& options = {},
                                const std::function<void(double)>& progress = nullptr, bool* read = nullptr);

/// MAP.places
std::string PlaceIndexPath(const std::string& map);

}  // namespace evit
