#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/geometry/rig.h"
#include "common/localization/place_index.h"
#include "common/localization/place_query.h"
#include "common/localization/yaw_search.h"
#include "common/map/map_index.h"
#include "common/tracking/localizer.h"
#include "common/tracking/tracker_options.h"

namespace evit {

struct PlaceFinderOptions {
  std::size_t matches = 48;  // places whose image is compared, after their panoramas: of 15,000; more of more
  std::size_t candidates = 8;  // in the answer to a search everywhere, at most
  std::size_t points = 900;    // of the map, to compare an image by
  int threads = 2;
  // Parts that may be left out, to measure what they are worth.
  bool panoramas = true;   // else the places that are compared are spread evenly
  bool directions = true;  // of edges, when panoramas are compared
};

/// Where in a map a keyframe may have been seen: all places and yaws by their panoramas (PlaceIndex), the
/// best of them by aligning the map with the image (Localize, SearchStart). Keeps no state but the map: the
/// same query has the same answer, whatever the number of threads.
class PlaceFinder {
 public:
  /// `map` and `index`, of the same map, must outlive this.
  PlaceFinder(const MapIndex& map, const PlaceIndex& index, const Rig& rig, const PointOptions& points,
              const WindowOptions& window, const PlaceFinderOptions& options = {});

  /// First the hypotheses, refined, in their order; then what else explains the view: everywhere, or around
  /// the best of the hypotheses. The others are the most significant first, and no two are one place.
  ///
  /// Everywhere, with hypotheses, also where the map looks as from the best of them: rooms alike, of which
  /// the events, with what they miss and add, may have shown only one.
  std::vector<PlaceCandidate> Answer(const PlaceQuery& query) const;

 private:
  std::vector<PlaceCandidate> Refined(const PlaceQuery& query, const SurfaceField& field) const;
  std::vector<PlaceCandidate> Everywhere(const PlaceQuery& query, const SurfaceField& field,
                                         const std::vector<PlaceCandidate>& refined) const;
  std::vector<PlaceMatch> Matches(const PlaceQuery& query, const cv::Mat& surface, std::size_t count) const;
  std::vector<PlaceMatch> SpreadEvenly(
      std::size_t count, const std::function<bool(const Eigen::Vector3f&, double)>& allowed) const;
  PlaceCandidate Aligned(const SurfaceField& field, const SE3& T_map_body, const StartRange& range) const;
  PlaceCandidate Searched(const SurfaceField& field, const SE3& T_map_body, const StartRange& range,
                          std::int64_t number) const;
  AlignmentPoints PointsAt(const SE3& T_map_body, std::size_t most) const;
  AlignmentPoints PointsAt(const SE3& T_map_body) const { return PointsAt(T_map_body, options_.points); }

  const MapIndex& map_;
  const PlaceIndex& index_;
  Rig rig_;
  PointOptions points_;
  AlignmentSettings alignment_;
  PlaceFinderOptions options_;
};

}  // namespace evit
