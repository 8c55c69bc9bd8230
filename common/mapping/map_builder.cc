#include "common/mapping/map_builder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

constexpr double kFirstGuess = 1.5;           // m: of the scene's depth
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

// The middle depth of the edges, from a few key views; 0 where none could be measured.
double FindDepth(const std::vector<PosedEdges>& views, const std::vector<int>& keys,
                 const MapBuilderOptions& options) {
  const EdgeStereo stereo(views, options.stereo);
  double depth = kFirstGuess;
  for (int round = 0; round < 2; ++round) {
    const int n = std::min(kProbes, static_cast<int>(keys.size()));
    std::vector<std::vector<double>> found(n);
    ParallelFor(n, options.threads, [&](int k) {
      const int key = keys[(2 * k + 1) * keys.size() / (2 * static_cast<std::size_t>(n))];
      const auto neighbours = ChooseNeighbours(views, key, depth, options.choice);
      for (const EdgeDepth& d : stereo.Measure(key, neighbours, StrideOf(views[key], 1000)))
        found[k].push_back(1 / d.inverse_depth);
    });
    std::vector<double> depths;
    for (const auto& part : found) depths.insert(depths.end(), part.begin(), part.end());
    if (depths.size() < 50) return round == 0 ? 0 : depth;
    depth = Median(depths);
  }
  return depth;
}

void RequireMotion(const std::vector<PosedEdges>& views, double depth, const MapBuilderOptions& options) {
  double farthest = 0;
  for (const PosedEdges& view : views)
    farthest = std::max(farthest, (view.T_map_camera.p - views.front().T_map_camera.p).norm());
  const double needed = depth * options.choice.min_parallax_deg * M_PI / 180 * 3;
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
  map->confirmed = points.size();
  points = ThinToLines(points, options.thinning, options.threads);
  progress(0.75, "fitting points and poses to all views");
  map->adjustment = EdgeAdjustment(&views, options.adjustment, options.threads).Run(&points);
  map->points = ThinToLines(points, options.thinning, options.threads);
  for (const PosedEdges& view : views) map->poses.push_back(view.T_map_camera);
  progress(1, std::to_string(map->points.size()) + " points");
}

}  // namespace

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
  held.adjustment.hold_sigmas = 1;  // measured, not triangulated: two views are enough to believe a place
  held.adjustment.min_views = std::min(options.adjustment.min_views, 3);
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
  const std::vector<int> keys = ChooseKeyViews(views, options.choice);
  progress(0, "looking for the scene's depth");
  map.typical_depth_m =
      options.typical_depth_m > 0 ? options.typical_depth_m : FindDepth(views, keys, options);
  if (map.typical_depth_m <= 0) {
    throw std::runtime_error(
        "hardly an edge agrees between the views: the poses do not belong to these images (another clock, "
        "order or frame), the camera's calibration is another one's, or the camera hardly moved");
  }

  std::vector<KeyDepths> depths(keys.size());
  {
    const EdgeStereo stereo(views, options.stereo);
    std::atomic<int> done{0};
    std::mutex mutex;  // of progress
    ParallelFor(static_cast<int>(keys.size()), options.threads, [&](int k) {
      const PosedEdges& view = views[keys[k]];
      const auto neighbours = ChooseNeighbours(views, keys[k], map.typical_depth_m, options.choice);
      depths[k] = {keys[k], stereo.Measure(keys[k], neighbours, StrideOf(view, kEdgesPerKey))};
      SmoothAlongEdges(view, options.fusion, &depths[k].depths);
      const std::lock_guard<std::mutex> lock(mutex);
      progress(0.05 + 0.6 * ++done / static_cast<double>(keys.size()), "depth of edges");
    });
  }
  Finish(std::move(views), depths, options, progress, &map);
  return map;
}

}  // namespace evit
