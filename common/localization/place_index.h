#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "common/localization/edge_points.h"
#include "common/localization/panorama.h"
#include "common/localization/place_grid.h"

namespace evit {

struct PlaceIndexOptions {
  EdgePointOptions edges;
  PlaceGridOptions grid;
  double min_depth = 0.2;          // m: edges nearer than that are left out
  double max_depth = 12;           // m
  int min_visible = 40;            // edges, from a place worth keeping
  std::size_t max_visible = 1024;  // edges of a place: of more than that, as many, evenly chosen
  int threads = 2;
};

/// What an upright viewer sees of a map's edges from each place of a grid: made once for a map, whatever the
/// rig. 2 bytes for each visible edge of each place: at most 123 MB with the limits of the options, and twice
/// that while it is made.
class PlaceIndex {
 public:
  /// An edge in the panorama of a place.
  struct Edge {
    std::uint16_t stacked_row : 9;
    std::uint16_t column : 7;
  };
  struct Place {
    Eigen::Vector3f at;        // map frame, m
    std::uint32_t begin, end;  // its edges
  };

  /// `progress`: called now and then with the share done, 0..1, by one thread at a time; may throw, which
  /// stops it.
  explicit PlaceIndex(const PointMap& map, const PlaceIndexOptions& options = {},
                      const std::function<void(double)>& progress = nullptr);

  /// One that was made before. The places' edges lie in `edges`.
  PlaceIndex(double spacing, std::vector<Place> places, std::vector<Edge> edges)
      : spacing_(spacing), places_(std::move(places)), edges_(std::move(edges)) {}

  const std::vector<Place>& places() const { return places_; }
  const Edge* edges() const { return edges_.data(); }
  std::size_t n_edges() const { return edges_.size(); }
  double spacing() const { return spacing_; }  // m, of the grid as it is
  std::size_t MemoryBytes() const;

 private:
  double spacing_;
  std::vector<Place> places_;
  std::vector<Edge> edges_;
};

}  // namespace evit
