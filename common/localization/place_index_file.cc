#include "common/localization/place_index_file.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "common/files/content_hash.h"
#include "common/files/whole_file.h"
#include "common/text/format_text.h"

namespace evit {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kVersion = 4;  // of the file, and of what an index holds: another one is made again
constexpr char kMagic[8] = {'E', 'V', 'I', 'T', 'P', 'L', 'A', 'C'};

// As they lie in memory, which is without gaps.
static_assert(sizeof(PlaceIndex::Edge) == 2 && sizeof(PlaceIndex::Place) == 20);

struct Header {
  char magic[8];
  std::uint64_t fingerprint, places, edges, checksum;
  double spacing;
};

std::uint64_t ChecksumOf(const PlaceIndex& index) {
  ContentHash hash;
  hash.AddValue(index.spacing());
  hash.Add(index.places().data(), index.places().size() * sizeof(PlaceIndex::Place));
  hash.Add(index.edges(), index.n_edges() * sizeof(PlaceIndex::Edge));
  return hash.value();
}

template <typename Item>
bool ReadAll(std::ifstream* file, std::size_t count, std::vector<Item>* items) {
  items->resize(count);
  file->read(reinterpret_cast<char*>(items->data()), static_cast<std::streamsize>(count * sizeof(Item)));
  return static_cast<bool>(*file);
}

// Of this user, for EVIT. Empty: there is none.
fs::path CacheFolder() {
  const auto named = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value == '/' ? fs::path(value) : fs::path();
  };
  if (fs::path folder = named("CACHE_DIRECTORY"); !folder.empty()) return folder;
  if (fs::path folder = named("XDG_CACHE_HOME"); !folder.empty()) return folder / "evit";
  const fs::path home = named("HOME");
  return home.empty() ? home : home / ".cache" / "evit";
}

}  // namespace

std::uint64_t FingerprintOf(const PointMap& map, const PlaceIndexOptions& o) {
  ContentHash hash;
  hash.AddValue(kVersion);
  for (const int size : {panorama::kColumns, panorama::kRows, panorama::kDirections, o.min_visible})
    hash.AddValue(size);
  for (const double value : {o.edges.spacing, o.edges.radius, o.grid.spacing, o.grid.beyond,
                             o.grid.beyond_open, o.min_depth, o.max_depth})
    hash.AddValue(value);
  for (const std::size_t most : {o.edges.max_points, o.grid.max_places, o.max_visible}) hash.AddValue(most);
  hash.Add(map.points.data(), map.points.size() * sizeof map.points[0]);
  return hash.value();
}

std::optional<PlaceIndex> ReadPlaceIndex(const std::string& path, std::uint64_t fingerprint) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size =
      static_cast<std::uint64_t>(std::max<std::streamoff>(0, file ? file.tellg() : std::streampos(0)));
  file.seekg(0);
  Header header{};
  file.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!file || std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || header.fingerprint != fingerprint)
    return std::nullopt;
  // Nothing is reserved that the file does not hold.
  if (header.places > size / sizeof(PlaceIndex::Place) || header.edges > size / sizeof(PlaceIndex::Edge) ||
      size != sizeof header + header.places * sizeof(PlaceIndex::Place) +
                  header.edges * sizeof(PlaceIndex::Edge)) {
    return std::nullopt;
  }
  std::vector<PlaceIndex::Place> places;
  std::vector<PlaceIndex::Edge> edges;
  if (!ReadAll(&file, header.places, &places) || !ReadAll(&file, header.edges, &edges)) return std::nullopt;
  PlaceIndex index(header.spacing, std::move(places), std::move(edges));
  if (header.checksum != ChecksumOf(index)) return std::nullopt;
  return index;
}

bool WritePlaceIndex(const std::string& path, std::uint64_t fingerprint, const PlaceIndex& index) {
  const std::size_t n_places = index.places().size(), n_edges = index.n_edges();
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.fingerprint = fingerprint;
  header.places = n_places;
  header.edges = n_edges;
  header.checksum = ChecksumOf(index);
  header.spacing = index.spacing();
  WholeFile file(path);
  const auto write = [&file](const void* data, std::size_t size) {
    file.stream().write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  };
  write(&header, sizeof header);
  write(index.places().data(), n_places * sizeof(PlaceIndex::Place));
  write(index.edges(), n_edges * sizeof(PlaceIndex::Edge));
  try {
    file.Commit();
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

PlaceIndex ReadOrMakePlaceIndex(const std::vector<std::string>& paths, const PointMap& map,
                                const PlaceIndexOptions& options, const std::function<void(double)>& progress,
                                bool* read) {
  const std::uint64_t fingerprint = FingerprintOf(map, options);
  if (read != nullptr) *read = false;
  for (const std::string& path : paths) {
    std::optional<PlaceIndex> kept = ReadPlaceIndex(path, fingerprint);
    if (!kept) continue;
    if (read != nullptr) *read = true;
    return std::move(*kept);
  }
  PlaceIndex made(map, options, progress);
  for (const std::string& path : paths) {
    std::error_code ignored;
    if (path != paths.front()) fs::create_directories(fs::path(path).parent_path(), ignored);
    if (WritePlaceIndex(path, fingerprint, made)) break;
  }
  return made;
}

std::vector<std::string> PlaceIndexPaths(const std::string& map) {
  if (map.empty()) return {};
  std::vector<std::string> paths{map + ".places"};
  std::error_code error;
  const fs::path whole = fs::absolute(map, error), cache = CacheFolder();
  if (error || cache.empty()) return paths;
  ContentHash hash;
  hash.Add(whole.c_str(), whole.native().size());
  char name[32];
  std::snprintf(name, sizeof name, ".%016llx.places", static_cast<unsigned long long>(hash.value()));
  paths.push_back((cache / (whole.filename().string() + name)).string());
  return paths;
}

std::string KeptPlaceIndexText(const std::string& map) {
  for (const std::string& path : PlaceIndexPaths(map)) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error)
      return FormatText("%s (%.1f MB; may be deleted)", path.c_str(), 1e-6 * static_cast<double>(size));
  }
  return "";
}

}  // namespace evit
