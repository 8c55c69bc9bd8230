#pragma once

#include <array>
#include <cstdint>

#include "common/events/active_event_surface.h"
#include "common/events/keyframe_policy.h"
#include "common/events/surface_options.h"
#include "common/events/surface_renderer.h"
#include "common/overlap/map_views.h"

namespace evit {

/// What time surfaces hold under a map's points: the residuals of a tracker that knows the pose.
struct SurfaceValues {
  static constexpr int kBins = 16;  // of 16 grey levels

  std::int64_t points = 0;
  double sum = 0, sum_beside = 0;               // grey levels 0..255; beside: mean of ten pixels to each side
  std::array<std::int64_t, kBins> histogram{};  // of the values

  double mean() const { return points > 0 ? sum / static_cast<double>(points) : 255; }
  /// As AlignmentQuality has it: 0 where the points lie no better than beside.
  double contrast() const { return sum_beside > 0 ? 1 - sum / sum_beside : 0; }
};

/// Draws the time surface of each view as the frame builder would and looks at it under the view's points.
class SurfaceMeter {
 public:
  /// `views`: in order of time; must outlive this. `surface`: how they are drawn; the decay follows the
  /// view's speed.
  SurfaceMeter(const Rig& rig, const std::vector<MapView>* views, const SurfaceOptions& surface = {});

  /// All events of the recording from before the first view's on, in order of time.
  void AddEvents(const EventArray& events);
  /// There are no more.
  void Finish();

  const SurfaceValues& total() const { return total_; }

 private:
  void Draw();

  Rig rig_;
  const std::vector<MapView>* views_;
  KeyframePolicy policy_;
  Utime lookahead_;
  ActiveEventSurface surface_;
  SurfaceRenderer renderer_;
  EventArray pending_;  // not in the surface yet
  std::size_t next_ = 0;
  SurfaceValues total_;
};

}  // namespace evit
