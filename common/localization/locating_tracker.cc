#include "common/localization/locating_tracker.h"

#include <utility>

#include "common/tracking/image_speed.h"

namespace evit {
namespace {

constexpr int kSpeedGrid = 6;  // points across the image

// Points in sight of a body at the origin, at a depth of 1 m.
AlignmentPoints PointsAllOver(const Camera& camera, const SE3& T_body_camera) {
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < kSpeedGrid; ++v) {
    for (int u = 0; u < kSpeedGrid; ++u) {
      Eigen::Vector3d ray;
      if (camera.Unproject({(u + 0.5) * camera.width / kSpeedGrid, (v + 0.5) * camera.height / kSpeedGrid},
                           &ray))
        points.emplace_back((T_body_camera * ray).cast<float>());
    }
  }
  return {points};
}

}  // namespace

LocatingTracker::LocatingTracker(std::unique_ptr<MapTracker> tracker, const Rig& rig,
                                 const TrackerOptions& tracker_options, const Options& options)
    : tracker_(std::move(tracker)),
      locator_(rig, tracker_options, options.search),
      options_(options),
      alignment_(MakeAlignmentSettings(rig, tracker_options.window)),
      far_(PointsAllOver(rig.camera, rig.T_body_camera)),
      searching_(options.from_nothing) {}

void LocatingTracker::Start(const SE3& T_map_body) {
  searching_ = false;
  tracker_->Start(T_map_body);
}

void LocatingTracker::Start(const BodyState& state) {
  searching_ = false;
  tracker_->Start(state);
}

void LocatingTracker::Start(Utime t, const BodyState& state, const Matrix15d& information) {
  searching_ = false;
  tracker_->Start(t, state, information);
}

void LocatingTracker::Search(TrackerMode mode) {
  searching_ = true;
  mode_ = mode;
  lost_since_ = 0;
  locator_.Restart();
}

TrackerOutput LocatingTracker::Process(const KeyframeInput& keyframe) {
  time_ = keyframe.t;
  if (searching_) return ProcessSearching(keyframe);
  TrackerOutput output = tracker_->Process(keyframe);
  if (output.mode != TrackerMode::kLost) {
    lost_since_ = 0;
  } else if (lost_since_ == 0) {
    lost_since_ = keyframe.t;
  } else if (options_.lost_s >= 0 && ToSeconds(keyframe.t - lost_since_) >= options_.lost_s) {
    Search(TrackerMode::kLost);
  }
  return output;
}

TrackerOutput LocatingTracker::ProcessSearching(const KeyframeInput& keyframe) {
  if (!keyframe.imu.empty()) rate_ = keyframe.imu.back().gyro;
  locator_.AddKeyframe(keyframe);
  if (const std::optional<BodyState> found = locator_.Found()) {
    searching_ = false;
    tracker_->Start(*found);
  }
  TrackerOutput output;
  output.mode = mode();
  output.reason = "looking for the place: " + locator_.Progress();
  output.image_speed = MedianImageSpeed(alignment_, far_, SE3(), Eigen::Vector3d::Zero(), rate_);
  return output;
}

}  // namespace evit
