#include "common/localization/place_index_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/files/content_hash.h"
#include "common/files/whole_file.h"

namespace evit {
namespace {

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

PlaceIndex ReadOrMakePlaceIndex(const std::string& path, const PointMap& map,
                                const PlaceIndexOptions& options, const std::function<void(double)>& progress,
                                bool* read) {
  const std::uint64_t fingerprint = FingerprintOf(map, options);
  if (read != nullptr) *read = false;
  if (!path.empty()) {
    if (std::optional<PlaceIndex> kept = ReadPlaceIndex(path, fingerprint)) {
      if (read != nullptr) *read = true;
      return std::move(*kept);
    }
  }
  PlaceIndex made(map, options, progress);
  if (!path.empty()) WritePlaceIndex(path, fingerprint, made);
  return made;
}

std::string PlaceIndexPath(const std::string& map) { return map + ".places"; }

}  // namespace evit
