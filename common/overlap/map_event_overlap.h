#pragma once

#include <array>
#include <cstdint>

#include "common/overlap/map_views.h"

namespace evit {

struct OverlapOptions {
  double radius_px = 2;   // what counts as "on": distance of a point to a pixel that fired, or back
  double reach_px = 8;    // up to where distances and offsets are measured
  double beside_px = 15;  // by which the map is shifted to see what chance alone gives
  double border_px = 4;   // points nearer to the image's border do not count
  bool both_ways = true;  // false: points only, several times faster; fired_on_map stays zero
};

/// How a map and events lie on each other at known poses. Counts add up over views.
struct MapEventOverlap {
  static constexpr int kBins = 16;  // of half a pixel

  std::int64_t views = 0;
  std::int64_t points = 0;            // in view
  std::int64_t points_on_events = 0;  // with a pixel that fired within the radius
  std::int64_t fired = 0;             // pixels that fired
  std::int64_t fired_on_map = 0;      // with a point of the map within the radius
  std::int64_t events = 0;            // several may be of one pixel
  std::int64_t map_pixels = 0;        // that points project to
  /// Of points to the nearest pixel that fired; those without one in reach are in `points` alone.
  std::array<std::int64_t, kBins> distances{};
  Eigen::Vector2d offset_sum = Eigen::Vector2d::Zero();  // pixels, from points on events to their events
  // The same, mean over the map shifted to four sides: what chance gives.
  double points_beside = 0, points_on_events_beside = 0, fired_on_map_beside = 0;
  double moved_px = 0;  // sum over views of the points' motion (median) during the slice

  void Add(const MapEventOverlap& other);

  double point_share() const { return Share(points_on_events, points); }
  double event_share() const { return Share(fired_on_map, fired); }
  double point_share_by_chance() const { return Share(points_on_events_beside, points_beside); }
  double event_share_by_chance() const { return Share(fired_on_map_beside, static_cast<double>(fired)); }
  /// 0: the map lies on the events no better than beside them; 1: all of it does, and nothing would by
  /// chance.
  double kappa() const {
    const double chance = point_share_by_chance();
    return chance < 1 ? (point_share() - chance) / (1 - chance) : 0;
  }
  /// The same of the pixels that fired: 0: the map explains none of them better than chance, 1: all.
  double event_kappa() const {
    const double chance = event_share_by_chance();
    return chance < 1 ? (event_share() - chance) / (1 - chance) : 0;
  }
  Eigen::Vector2d mean_offset() const {
    return points_on_events > 0 ? Eigen::Vector2d(offset_sum / static_cast<double>(points_on_events))
                                : Eigen::Vector2d::Zero();
  }
  /// Events per pixel of the map's edges and pixel of motion.
  double events_per_edge_pixel() const {
    const double swept =
        static_cast<double>(map_pixels) * (views > 0 ? moved_px / static_cast<double>(views) : 0);
    return swept > 0 ? static_cast<double>(events) * event_share() / swept : 0;
  }

 private:
  template <typename A, typename B>
  static double Share(A part, B whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
  }
};

/// Of one view whose events are in, with the camera at T_map_body * T_body_camera.
MapEventOverlap MeasureOverlap(const Camera& camera, const SE3& T_map_camera, const MapView& view,
                               const OverlapOptions& options = {});
/// Of many, at the rig's extrinsics.
MapEventOverlap MeasureOverlap(const Rig& rig, const std::vector<MapView>& views,
                               const OverlapOptions& options = {});

}  // namespace evit
