#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/map/view_projector.h"

namespace evit {

/// The active point set (paper Sec. III-D): map points seen in the last window, merged with those in a wider
/// frustum of the predicted pose.
class ActivePoints {
 public:
  ActivePoints(const Camera& camera, const SE3& T_camera_body, std::uint64_t seed);

  /// Adds what the wider frustum of a predicted pose shows (map server's answer). ids: indices into the map.
  void Merge(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points);

  /// Keeps only points inside the image (plus `margin_px`) seen from one of these poses.
  void Retain(const std::vector<SE3>& T_map_body, double margin_px);

  /// A random subset of at most `count` points inside the image seen from this pose, spread over the image:
  /// tiles of 32x32 pixels take turns, so that densely mapped spots do not eat the budget. Depends on seed,
  /// `salt`, pose and the set alone, not on the order in which points came.
  std::vector<Eigen::Vector3f> Sample(const SE3& T_map_body, int count, std::uint64_t salt) const;

  /// By how many pixels points in view from `to` move over the image on the way there from `from` (poses of
  /// the body): what nine of ten stay below. Infinite where too few are in view to tell.
  double Shift(const SE3& from, const SE3& to) const;

  std::size_t size() const { return ids_.size(); }
  void Clear();

 private:
  /// Points in view; their `id` is the place in points_.
  std::vector<ProjectedPoint> Seen(const SE3& T_map_body, double margin_px) const;

  /// Of some of them: those at these places.
  std::vector<ProjectedPoint> SeenOf(const PointArrays& points, const std::vector<std::int32_t>& places,
                                     const SE3& T_map_body, double margin_px) const;

  Camera camera_;
  SE3 T_camera_body_;
  std::uint64_t seed_;
  std::vector<std::int32_t> ids_;  // ascending
  PointArrays points_;             // same order
};

}  // namespace evit
