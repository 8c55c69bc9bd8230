#include "common/mapping/map_builder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "common/geometry/degrees.h"
#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

constexpr int kLagRounds = 4;
constexpr int kProbes = 6;                    // key views that the scene's depth is found from
constexpr std::size_t kEdgesPerKey = 16'000;  // measured, at most: of larger images every n-th edge pixel

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int StrideOf(const PosedEdges& view, std::size_t limit) {
  return 1 + static_cast<int>(view.edges.edges().size() / limit);
}

// Moves the edges of a view on by `lag_px`, the way they go.
void MoveOn(double lag_px, double depth, PosedEdges* view) {
  const Camera& c = view->camera;
  std::vector<EdgePixel> edges = view->edges.edges();
  for (EdgePixel& edge : edges) {
    const Eigen::Vector3d ray((edge.pixel.x() - c.cx) / c.fx, (edge.pixel.y() - c.cy) / c.fy, 1);
    edge.pixel += static_cast<float>(lag_px * view->sweep.Way(c, depth * ray, edge.normal)) * edge.normal;
  }
  view->edges =
      EdgeImage(view->edges.width(), view->edges.height(), std::move(edges), view->edges.has_sides());
}

// Depths of some edges of a few key views.
std::vector<EdgeDepth> Probe(const std::vector<PosedEdges>& views, double depth,
                             const MapBuilderOptions& options) {
  const std::vector<int> keys = ChooseKeyViews(views, options.choice);
  const EdgeStereo stereo(views, options.stereo);
  const int n = std::min(kProbes, static_cast<int>(keys.size()));
  std::vector<std::vector<EdgeDepth>> found(n);
  ParallelFor(n, options.threads, [&](int k) {
    const int key = keys[(2 * k + 1) * keys.size() / (2 * static_cast<std::size_t>(n))];
    const auto neighbours = ChooseNeighbours(views, key, depth, options.choice);
    found[k] = stereo.Measure(key, neighbours, StrideOf(views[key], 1000), depth);
  });
  std::vector<EdgeDepth> depths;
  for (const auto& part : found) depths.insert(depths.end(), part.begin(), part.end());
  return depths;
}

void RequireMotion(const std::vector<PosedEdges>& views, double depth, const MapBuilderOptions& options) {
  double farthest = 0;
  for (const PosedEdges& view : views)
    farthest = std::max(farthest, (view.T_map_camera.p - views.front().T_map_camera.p).norm());
  const double needed = depth * options.choice.min_parallax_deg * kRadiansPerDegree * 3;
  if (farthest >= needed) return;
  throw std::runtime_error("the camera moved by no more than " +
                           std::to_string(static_cast<int>(1000 * farthest)) +
                           " mm between the views: depth needs a baseline, turning alone gives none");
}

// From depths to lines; poses and points fitted to all views.
void Finish(std::vector<PosedEdges> views, const std::vector<KeyDepths>& depths,
            const MapBuilderOptions& options, const MapProgress& progress, BuiltMap* map) {
  map->key_views = static_cast<int>(depths.size());
  for (const KeyDepths& key : depths) map->measured += key.depths.size();
  progress(0.65, "fusing views");
  std::vector<MappedPoint> points = FuseDepths(views, depths, options.fusion, options.threads);
  // Stereo asked several views; a depth of a sensor that is still of one is so for want of another that
  // looks.
  map->alone = static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [](const MappedPoint& p) { return p.views < 2; }));
  map->confirmed = points.size() - map->alone;
  const LineThinningOptions thinning = ForDepth(options.thinning, map->typical_depth_m);
  points = ThinToLines(points, thinning, options.threads);
  progress(0.75, "fitting points and poses to all views");
  map->adjustment = EdgeAdjustment(&views, options.adjustment, options.threads).Run(&points);
  points = options.smooth_fitted ? ThinToLines(points, thinning, options.threads)
                                 : ThinToVoxels(points, thinning.voxel_m);
  map->points = DropLonePoints(points, thinning, options.threads);
  // Held by less than its sigma a point stays nearer to where it was measured, but is not better known.
  const double hold = options.adjustment.hold_sigmas;
  if (hold > 0 && hold < 1) {
    for (MappedPoint& p : map->points) p.sigma /= hold;
  }
  for (const PosedEdges& view : views) map->poses.push_back(view.T_map_camera);
  progress(1, std::to_string(map->points.size()) + " points");
}

}  // namespace

double SceneDepth(const std::vector<PosedEdges>& views, const MapBuilderOptions& options) {
  double depth = kFirstDepth;
  for (int round = 0; round < 2; ++round) {
    std::vector<double> depths;
    for (const EdgeDepth& d : Probe(views, depth, options)) depths.push_back(1 / d.inverse_depth);
    if (depths.size() < 50) return round == 0 ? 0 : depth;
    depth = Median(depths);
  }
  return depth;
}

double TakeOutLag(double depth, const MapBuilderOptions& options, std::vector<PosedEdges>* views) {
  MapBuilderOptions unknown = options;
  unknown.stereo.lag_sigma_px = 2;
  double total = 0;
  // Far off, edges find their like in part only, and say too little.
  for (int round = 0; round < kLagRounds; ++round) {
    std::vector<double> lags;
    for (const EdgeDepth& d : Probe(*views, depth, unknown)) {
      if (d.lag_sigma > 0 && d.lag_sigma < 0.5) lags.push_back(d.lag);
    }
    if (lags.size() < 50) break;
    const double lag = Median(lags);
    for (PosedEdges& view : *views) MoveOn(lag, depth, &view);
    total += lag;
    if (std::abs(lag) < 0.03) break;
  }
  return total;
}

MapBuilderOptions OptionsForEvents(MapBuilderOptions options) {
  // A view shows the edges across its motion alone: more of them, and from nearer by.
  options.choice.neighbours = 24;
  options.fusion.min_other_keys = 2;
  options.stereo.edge_sigma_px = options.adjustment.edge_sigma_px = 0.6;
  options.stereo.min_share = 0.4;
  options.adjustment.min_share = 0.3;
  // Depths are several times as rough: each needs its neighbours along a longer part of the line.
  options.thinning.finer_near = false;
  options.smooth_fitted = true;
  options.adjustment.hold_sigmas = 5;
  return options;
}

BuiltMap BuildMapFromDepths(std::vector<PosedEdges> views, std::vector<KeyDepths> depths,
                            const MapBuilderOptions& options, const MapProgress& progress) {
  BuiltMap map;
  std::vector<double> all;
  for (KeyDepths& key : depths) {
    SmoothAlongEdges(views[key.view], options.fusion, &key.depths);
    for (const EdgeDepth& d : key.depths) all.push_back(1 / d.inverse_depth);
  }
  if (all.empty()) throw std::runtime_error("no edge of any view has a depth");
  map.typical_depth_m = Median(all);
  MapBuilderOptions held = options;
  // Measured, not triangulated: two views are enough to accept a place, one where no other looks.
  held.adjustment.hold_sigmas = 1;
  held.adjustment.min_views = std::min(options.adjustment.min_views, 2);
  held.adjustment.fewer_if_all = true;
  held.fusion.least_keys = 0;
  // The sensor's noise does not shrink with the distance of a line's points.
  held.thinning.finer_near = false;
  held.smooth_fitted = true;
  held.thinning.min_share = 0;  // no depth is one of another edge
  held.adjustment.min_share = std::min(options.adjustment.min_share, 0.25);
  held.fusion.min_other_keys = std::min(options.fusion.min_other_keys, 1);
  held.fusion.relative_tolerance = std::max(options.fusion.relative_tolerance, 0.02);
  Finish(std::move(views), depths, held, progress, &map);
  return map;
}

BuiltMap BuildMap(std::vector<PosedEdges> views, const MapBuilderOptions& options,
                  const MapProgress& progress) {
  if (views.size() < 3) {
    throw std::runtime_error("a map needs at least three views with edges, there are " +
                             std::to_string(views.size()));
  }
  RequireMotion(views, options.typical_depth_m > 0 ? options.typical_depth_m : options.stereo.min_depth_m,
                options);
  BuiltMap map;
  progress(0, "looking for the scene's depth");
  map.typical_depth_m = options.typical_depth_m > 0 ? options.typical_depth_m : SceneDepth(views, options);
  if (map.typical_depth_m <= 0) {
    throw std::runtime_error(
        "almost no edge agrees between the views: the poses do not belong to these images (another clock, "
        "order or frame), the camera's calibration is another one's, or the camera barely moved");
  }

  const std::vector<int> keys = ChooseKeyViews(views, options.choice);
  std::vector<KeyDepths> depths(keys.size());
  {
    const EdgeStereo stereo(views, options.stereo);
    std::atomic<int> done{0};
    std::mutex mutex;  // of progress
    ParallelFor(static_cast<int>(keys.size()), options.threads, [&](int k) {
      const PosedEdges& view = views[keys[k]];
      const auto neighbours = ChooseNeighbours(views, keys[k], map.typical_depth_m, options.choice);
      depths[k] = {keys[k],
                   stereo.Measure(keys[k], neighbours, StrideOf(view, kEdgesPerKey), map.typical_depth_m)};
      SmoothAlongEdges(view, options.fusion, &depths[k].depths);
      const std::lock_guard<std::mutex> lock(mutex);
      progress(0.05 + 0.6 * ++done / static_cast<double>(keys.size()), "depth of edges");
    });
  }
  for (const int key : keys) {
    map.tried +=
        views[key].edges.edges().size() / static_cast<std::size_t>(StrideOf(views[key], kEdgesPerKey));
  }
  Finish(std::move(views), depths, options, progress, &map);
  return map;
}

}  // namespace evit
