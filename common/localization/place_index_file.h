#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

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

/// From the first of the files that fits the map; else made, and kept in the first that can be written, whose
/// folder is made where only that is missing. No paths: made, not kept. `progress`: PlaceIndex's; not called
/// where a file was read. `read`, where not null: whether one was.
PlaceIndex ReadOrMakePlaceIndex(const std::vector<std::string>& paths, const PointMap& map,
                                const PlaceIndexOptions& options = {},
                                const std::function<void(double)>& progress = nullptr, bool* read = nullptr);

/// Where the index of a map file may be kept, best first: beside the map, as MAP.places, and where its folder
/// cannot be written, in the user's cache folder (CACHE_DIRECTORY of systemd, else evit/ in XDG_CACHE_HOME or
/// in
/// ~/.cache), under a name that tells maps of one name apart. Of an empty name: nowhere.
std::vector<std::string> PlaceIndexPaths(const std::string& map);

/// Which of these is there, with its size and that it may be deleted: "map.pcd.places (24.5 MB; may be
/// deleted)". Empty: none.
std::string KeptPlaceIndexText(const std::string& map);

}  // namespace evit
