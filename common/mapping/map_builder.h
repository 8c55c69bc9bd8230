#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "common/mapping/depth_fusion.h"
#include "common/mapping/edge_adjustment.h"
#include "common/mapping/edge_stereo.h"
#include "common/mapping/line_thinning.h"
#include "common/mapping/view_choice.h"

namespace evit {

struct MapBuilderOptions {
  ViewChoiceOptions choice;
  EdgeStereoOptions stereo;
  DepthFusionOptions fusion;
  LineThinningOptions thinning;
  EdgeAdjustmentOptions adjustment;
  // Points move onto the line through their neighbours once more after they were fitted to the views: where
  // single depths are rough.
  bool smooth_fitted = false;
  double typical_depth_m = 0;  // of the scene; 0: found from a few views
  int threads = 2;
};

struct BuiltMap {
  std::vector<MappedPoint> points;
  std::vector<SE3> poses;  // T_map_camera of each view, adjusted
  double typical_depth_m = 0;
  double event_lag_px = 0;  // that was put right before
  int key_views = 0;
  std::size_t tried = 0;     // edges of key views whose depth was looked for; 0: a sensor or events told it
  std::size_t measured = 0;  // depths
  std::size_t alone = 0;     // of them, where no other view looks (of a sensor's depths; others do not count)
  std::size_t confirmed = 0;                                   // of the rest, by other views
  std::size_t comparable() const { return measured - alone; }  // depths at places that other views see
  /// 0..1: of the depths that other views could confirm, those they do. 1 if there are none.
  double ConfirmedShare() const {
    return comparable() > 0 ? static_cast<double>(confirmed) / static_cast<double>(comparable()) : 1;
  }
  AdjustmentSummary adjustment;
};

/// m: how far away things are taken to be before anything is known of it.
inline constexpr double kFirstDepth = 1.5;

/// What is different where the views are an event camera's (EventView).
MapBuilderOptions OptionsForEvents(MapBuilderOptions options);

/// The middle depth of the edges, m, from a few key views; 0 where hardly any could be measured.
double SceneDepth(const std::vector<PosedEdges>& views, const MapBuilderOptions& options);

/// Events come late: a pixel fires when its light has changed by a whole threshold, and by then the edge has
/// moved on, by as many pixels whatever its speed. Moves the edges of event views on by what the edges of a
/// few key views say that are seen to go both ways, and returns it, px. `depth`: m, of the scene.
double TakeOutLag(double depth, const MapBuilderOptions& options, std::vector<PosedEdges>* views);

/// How far it is, 0..1, and with what.
using MapProgress = std::function<void(double share, const std::string& what)>;

/// A semi-dense map from edges seen from known places: depth of the edges of key views (EdgeStereo), those
/// that agree fused (FuseDepths), thinned to lines (ThinToLines), points and poses fitted to all views
/// (EdgeAdjustment). Same views, same map, whatever the number of threads. Throws std::runtime_error with the
/// remedy where there are too few views, they have hardly any edges, or the camera hardly moved. An empty map
/// is possible: then nothing agreed.
BuiltMap BuildMap(std::vector<PosedEdges> views, const MapBuilderOptions& options,
                  const MapProgress& progress);

/// The same from depths that a sensor measured at the edges of the views (`depths`: some or all views,
/// ascending) instead of stereo: they hold the points at their distance while images say where edges run.
BuiltMap BuildMapFromDepths(std::vector<PosedEdges> views, std::vector<KeyDepths> depths,
                            const MapBuilderOptions& options, const MapProgress& progress);

}  // namespace evit
