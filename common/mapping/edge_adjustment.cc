#include "common/mapping/edge_adjustment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "common/geometry/degrees.h"
#include "common/mapping/edge_sighting.h"
#include "common/mapping/view_pose_fit.h"
#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

constexpr int kViewsPerPoint = 150;  // about, while points are on their way
constexpr double kLenient = 0.6;  // of the views that a point takes, while points and poses are on their way

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// What views show of all points.
struct EdgeAdjustment::Sightings {
  std::vector<PointEvidence> of_points;
  double squares = 0;  // px^2: of the distances of those that agree
  std::size_t agree = 0;

  void Add(const Sightings& other) {
    for (std::size_t k = 0; k < of_points.size(); ++k) of_points[k].Add(other.of_points[k]);
    squares += other.squares;
    agree += other.agree;
  }
  double Rms() const { return agree > 0 ? std::sqrt(squares / static_cast<double>(agree)) : 0; }
};

void EdgeAdjustment::CollectIn(int k, const std::vector<MappedPoint>& points, const Search& search,
                               Sightings* sightings) const {
  const PosedEdges& view = (*views_)[k];
  const PinholeView pinhole(view.T_map_camera, view.camera);
  for (const std::int32_t id : VisiblePoints(view, points)) {
    if ((id + k) % search.every != 0) continue;
    const Eigen::Vector3d p = pinhole.InCamera(points[id].position);
    const std::optional<EdgeSighting> sighting = SightEdge(pinhole, view, points[id], p, search.radius);
    if (!sighting) continue;
    sightings->of_points[id].Add(*sighting, pinhole, options_.edge_sigma_px);
    if (!sighting->Agrees()) continue;
    sightings->squares += sighting->off * sighting->off;
    ++sightings->agree;
  }
}

EdgeAdjustment::Sightings EdgeAdjustment::Collect(const std::vector<MappedPoint>& points,
                                                  const Search& search) const {
  // In parts of fixed size, summed in their order: the same result whatever the number of threads.
  const int n_views = static_cast<int>(views_->size()), parts = std::clamp(n_views, 1, 8);
  std::vector<Sightings> sightings(parts, {std::vector<PointEvidence>(points.size())});
  ParallelFor(parts, threads_, [&](int part) {
    for (int k = part; k < n_views; k += parts) CollectIn(k, points, search, &sightings[part]);
  });
  for (int part = 1; part < parts; ++part) sightings.front().Add(sightings[part]);
  return std::move(sightings.front());
}

EdgeAdjustment::Search EdgeAdjustment::SearchOf(int round) const {
  const double radius = options_.first_radius_px + (options_.last_radius_px - options_.first_radius_px) *
                                                       round / std::max(1, options_.rounds);
  const bool last = round == options_.rounds;
  // In the end a point is asked for in all views: how many show it counts.
  return {radius, last ? 1 : 1 + (static_cast<int>(views_->size()) - 1) / kViewsPerPoint, last};
}

bool EdgeAdjustment::IsShown(const PointEvidence& evidence, const Search& search) const {
  const double strict = search.last ? 1 : kLenient;
  double views = static_cast<double>(options_.min_views) / search.every;
  if (options_.fewer_if_all) views = std::min<double>(views, evidence.expected());
  return evidence.seen() >= strict * views &&
         static_cast<double>(evidence.seen()) / evidence.expected() >= strict * options_.min_share;
}

void EdgeAdjustment::FitPoints(const Sightings& sightings, const Search& search,
                               std::vector<MappedPoint>* points, std::vector<MappedPoint>* measured) const {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points->size(); ++k) {
    const PointEvidence& evidence = sightings.of_points[k];
    MappedPoint point = (*points)[k];
    if (evidence.expected() > 0) {
      point.views = evidence.seen();
      point.seen = static_cast<double>(evidence.seen()) / evidence.expected();
      if (!IsShown(evidence, search)) continue;
      evidence.Fit((*measured)[k], !search.last, options_, &point);
    } else if (search.last || !options_.fewer_if_all) {
      continue;
    }
    (*points)[kept] = point;
    (*measured)[kept] = (*measured)[k];
    ++kept;
  }
  points->resize(kept);
  measured->resize(kept);
}

AdjustmentSummary EdgeAdjustment::Run(std::vector<MappedPoint>* points) {
  AdjustmentSummary summary;
  std::vector<SE3> given;
  for (const PosedEdges& view : *views_) given.push_back(view.T_map_camera);
  std::vector<MappedPoint> measured = *points;
  for (int round = 0; round <= options_.rounds; ++round) {
    const Search search = SearchOf(round);
    const Sightings sightings = Collect(*points, search);
    (round == 0 ? summary.rms_before_px : summary.rms_after_px) = sightings.Rms();
    FitPoints(sightings, search, points, &measured);
    if (search.last || !options_.move_poses) continue;
    ParallelFor(static_cast<int>(views_->size()), threads_,
                [&](int k) { FitViewPose(*points, search.radius, given[k], options_, &(*views_)[k]); });
  }
  std::vector<double> moved, turned;
  for (std::size_t k = 0; k < given.size(); ++k) {
    const SE3& pose = (*views_)[k].T_map_camera;
    moved.push_back((pose.p - given[k].p).norm());
    turned.push_back(AngularDistance(pose.q, given[k].q) / kRadiansPerDegree);
  }
  summary.moved_m = Median(moved);
  summary.turned_deg = Median(turned);
  return summary;
}

}  // namespace evit
