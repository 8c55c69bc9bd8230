#include "common/tracking/point_selector.h"

#include "common/tracking/event_lag.h"

namespace evit {

PointSelector::PointSelector(const Rig& rig, const AlignmentSettings& alignment, const PointOptions& options,
                             double lag_px)
    : camera_(rig.camera),
      T_body_camera_(rig.T_body_camera),
      alignment_(alignment),
      options_(options),
      lag_px_(lag_px),
      active_(rig.camera, rig.T_body_camera.Inverse(), static_cast<std::uint64_t>(options.seed)) {}

VisibilityQuery PointSelector::QueryFrom(const SE3& T_map_body) const {
  VisibilityQuery query;
  query.T_map_camera = T_map_body * T_body_camera_;
  query.camera = camera_;
  query.margin_px = options_.margin_px;
  query.min_depth = options_.min_depth_m;
  query.max_depth = options_.max_depth_m;
  query.occlusion = options_.occlusion;
  query.max_points = static_cast<int>(share_ * options_.max_active);
  query.seed = static_cast<std::uint64_t>(options_.seed);
  return query;
}

bool PointSelector::Suffice(const VisibilityQuery& answered, const VisibilityQuery& query) const {
  constexpr double kShare = 0.75;  // of the margin; a tenth of the points move farther
  if (answered.max_points != query.max_points || answered.margin_px != query.margin_px) return false;
  const SE3 T_camera_body = T_body_camera_.Inverse();
  return active_.Shift(answered.T_map_camera * T_camera_body, query.T_map_camera * T_camera_body) <=
         kShare * query.margin_px;
}

void PointSelector::Add(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points,
                        const std::vector<SE3>& T_map_body) {
  active_.Retain(T_map_body, 0);
  if (active_.size() > 2 * static_cast<std::size_t>(options_.max_active)) active_.Clear();
  active_.Merge(ids, points);
}

AlignmentPoints PointSelector::Select(const BodyState& predicted, const Eigen::Vector3d& rate, int count,
                                      std::int64_t seq) const {
  return CompensateEventLag(alignment_,
                            active_.Sample(predicted.T_map_body, count, static_cast<std::uint64_t>(seq)),
                            predicted.T_map_body, predicted.velocity, rate, lag_px_);
}

}  // namespace evit
