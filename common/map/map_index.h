#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/map/point_map.h"

namespace evit {

/// What a camera is asked to see.
struct VisibilityQuery {
  SE3 T_map_camera;
  Camera camera;
  double margin_px = 0;     // the frustum is this much wider than the image on each side
  double min_depth = 0.1;   // m
  double max_depth = 20.0;  // m
  bool occlusion = true;    // leave out points hidden behind nearer ones (coarse depth buffer)
  int max_points = 0;       // random subset of this size where more are visible; 0: all
  std::uint64_t seed = 0;   // of the subset: same query, same answer, bit for bit
};

struct VisibilityAnswer {
  std::vector<std::int32_t> ids;  // indices into the map, ascending
  std::int32_t n_visible = 0;     // before the subset was taken
};

/// A map with a spatial index, for frustum and occlusion queries.
class MapIndex {
 public:
  explicit MapIndex(PointMap map);
  ~MapIndex();
  MapIndex(MapIndex&&) noexcept;
  MapIndex& operator=(MapIndex&&) noexcept;

  const PointMap& map() const;
  std::size_t MemoryBytes() const;
  VisibilityAnswer Query(const VisibilityQuery& query) const;

 private:
  std::vector<std::pair<std::size_t, std::size_t>> CellsInView(const VisibilityQuery& query,
                                                               const SE3& T_camera_map) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace evit
