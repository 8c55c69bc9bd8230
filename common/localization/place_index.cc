#include "common/localization/place_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "common/map/view_projector.h"
#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

using namespace panorama;  // NOLINT(google-build-using-namespace): this file is about nothing else

constexpr std::size_t kBlock = 256;  // places that a thread takes at a time
constexpr std::size_t kCells = std::size_t{kRows} * kColumns;
constexpr int kPatch = 4;  // bins: of the panorama, that are thinned together
constexpr std::size_t kPatches = kCells / kPatch / kPatch;
constexpr int kPatchEdges = 6;
constexpr float kBehind = 1.15F, kBehindM = 0.1F;  // farther by that much than what lies around it: hidden

// Edges as loops over lanes take them: places, and directions (zero: none).
struct EdgeArrays {
  PointArrays at, along;
};

// Of each edge as seen from a place: where it lies in the panorama, its distance (0: out of range), and a bit
// for the picture of its direction.
struct Seen {
  std::vector<std::int32_t> places, bits;
  std::vector<float> depths;
};

EVIT_MULTIVERSION void LookAt(const EdgeArrays& edges, const float* at, float near2, float far2, Seen* seen) {
  const float *px = edges.at.x(), *py = edges.at.y(), *pz = edges.at.z();
  const float *dx = edges.along.x(), *dy = edges.along.y(), *dz = edges.along.z();
  std::int32_t *places = seen->places.data(), *bits = seen->bits.data();
  float* depths = seen->depths.data();
  const std::size_t n = edges.at.size();
  for (std::size_t k = 0; k < n; ++k) {
    const float x = px[k] - at[0], y = py[k] - at[1], z = pz[k] - at[2];
    const float r2 = x * x + y * y + z * z;
    places[k] = PlaceOf(x, y, z);
    depths[k] = r2 < near2 || r2 > far2 ? 0 : std::sqrt(r2);
    const int bit = 1 << DirectionBin(LineAt(x, y, z, dx[k], dy[k], dz[k]));
    bits[k] = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k] > 0 ? bit : 1 << kAnyDirection;
  }
}

// The panorama of one place, with a depth buffer.
class View {
 public:
  View(const std::vector<EdgePoint>& edges, const PlaceIndexOptions& options)
      : near2_(static_cast<float>(options.min_depth * options.min_depth)),
        far2_(static_cast<float>(options.max_depth * options.max_depth)),
        most_(options.max_visible) {
    edges_.at.Resize(edges.size());
    edges_.along.Resize(edges.size());
    for (std::size_t k = 0; k < edges.size(); ++k) {
      edges_.at.Set(k, edges[k].at);
      edges_.along.Set(k, edges[k].along);
    }
    seen_.places.resize(edges.size());
    seen_.bits.resize(edges.size());
    seen_.depths.resize(edges.size());
  }

  // The edges visible from `at`, each place and direction once, to `visible`.
  void From(const Eigen::Vector3f& at, std::vector<PlaceIndex::Edge>* visible) {
    FillDepths(at);
    FindHorizon();
    std::array<std::uint8_t, kCells> held{};
    for (std::size_t k = 0; k < edges_.at.size(); ++k) {
      const std::int32_t place = seen_.places[k];
      const bool visible_there =
          seen_.depths[k] > 0 && seen_.depths[k] <= kBehind * horizon_[place] + kBehindM;
      held[place] |= static_cast<std::uint8_t>(visible_there ? seen_.bits[k] : 0);
    }
    visible->clear();
    for (int row = 0; row < kStackedRows; ++row) {
      const auto bit = static_cast<std::uint8_t>(1 << row / kRows);
      for (int column = 0; column < kColumns; ++column) {
        if ((held[row % kRows * kColumns + column] & bit) != 0)
          visible->push_back({static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(column)});
      }
    }
    FlattenCrowds(visible);
    const std::size_t all = visible->size();
    if (all <= most_) return;
    for (std::size_t k = 0; k < most_; ++k) (*visible)[k] = (*visible)[k * all / most_];
    visible->resize(most_);
  }

 private:
  // Of a crowd of edges keeps as many, evenly chosen, as an emptier part of the view may have: neighbouring
  // edges meet the same events, so that a place would score well only because it sees a crowd.
  static void FlattenCrowds(std::vector<PlaceIndex::Edge>* visible) {
    constexpr int kAcross = kColumns / kPatch;
    const auto patch_of = [](PlaceIndex::Edge e) {
      return e.stacked_row % kRows / kPatch * kAcross + e.column / kPatch;
    };
    std::array<int, kPatches> all{}, seen{};
    for (const PlaceIndex::Edge& e : *visible) ++all[patch_of(e)];
    const auto crowded = [&](PlaceIndex::Edge e) {
      const int n = all[patch_of(e)], k = seen[patch_of(e)]++;
      return n > kPatchEdges && (k + 1) * kPatchEdges / n == k * kPatchEdges / n;
    };
    visible->erase(std::remove_if(visible->begin(), visible->end(), crowded), visible->end());
  }
  void FillDepths(const Eigen::Vector3f& at) {
    LookAt(edges_, at.data(), near2_, far2_, &seen_);
    nearest_.fill(std::numeric_limits<float>::infinity());
    for (std::size_t k = 0; k < edges_.at.size(); ++k) {
      float& nearest = nearest_[seen_.places[k]];
      if (seen_.depths[k] > 0) nearest = std::min(nearest, seen_.depths[k]);
    }
  }

  // A map of edges has no surfaces: a place lies behind something only where nearer edges are on at least
  // three of four sides of it (as RemoveOccluded has it). The horizon is the third nearest of these sides.
  void FindHorizon() {
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        if (std::isinf(nearest_[row * kColumns + column])) continue;  // nobody asks
        std::array<float, 4> sides;
        sides.fill(std::numeric_limits<float>::infinity());
        for (int dr = -2; dr <= 2; ++dr) {
          if (row + dr < 0 || row + dr >= kRows) continue;
          for (int dc = -2; dc <= 2; ++dc) {
            if (dr == 0 && dc == 0) continue;
            // Four sides like a pinwheel, six places each.
            const int side = dr < 0 && dc <= 0 ? 0 : dc > 0 && dr <= 0 ? 1 : dr > 0 && dc >= 0 ? 2 : 3;
            const float depth = nearest_[(row + dr) * kColumns + ((column + dc) & (kColumns - 1))];
            sides[side] = std::min(sides[side], depth);
          }
        }
        std::nth_element(sides.begin(), sides.begin() + 2, sides.end());
        horizon_[row * kColumns + column] = sides[2];
      }
    }
  }

  EdgeArrays edges_;
  float near2_, far2_;
  std::size_t most_;
  Seen seen_;
  std::array<float, kCells> nearest_, horizon_;
};

}  // namespace

PlaceIndex::PlaceIndex(const PointMap& map, const PlaceIndexOptions& options,
                       const std::function<void(double)>& progress)
    : spacing_(options.grid.spacing) {
  if (map.points.empty()) return;
  const std::vector<EdgePoint> edges = ThinEdges(map, options.edges);
  const PlaceGrid made = MakePlaceGrid(edges, options.grid);
  const std::vector<Eigen::Vector3f>& grid = made.places;
  spacing_ = made.spacing;
  std::vector<std::vector<Edge>> visible(grid.size());
  std::mutex reporting;
  const auto blocks = static_cast<int>((grid.size() + kBlock - 1) / kBlock);
  ParallelFor(blocks, options.threads, [&](int block) {
    View view(edges, options);
    std::vector<Edge> seen;
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t k = first; k < std::min(grid.size(), first + kBlock); ++k) {
      view.From(grid[k], &seen);
      if (seen.size() >= static_cast<std::size_t>(options.min_visible)) visible[k] = seen;
    }
    const std::lock_guard<std::mutex> lock(reporting);
    if (progress) progress(static_cast<double>(first) / static_cast<double>(grid.size()));
  });
  std::size_t total = 0;
  for (const std::vector<Edge>& edges_seen : visible) total += edges_seen.size();
  edges_.reserve(total);
  for (std::size_t k = 0; k < grid.size(); ++k) {
    if (visible[k].empty()) continue;
    const auto begin = static_cast<std::uint32_t>(edges_.size());
    edges_.insert(edges_.end(), visible[k].begin(), visible[k].end());
    places_.push_back({grid[k], begin, static_cast<std::uint32_t>(edges_.size())});
    std::vector<Edge>().swap(visible[k]);
  }
}

std::size_t PlaceIndex::MemoryBytes() const {
  return places_.capacity() * sizeof(Place) + edges_.capacity() * sizeof(Edge);
}

}  // namespace evit
