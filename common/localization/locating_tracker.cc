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
      scale_(rig.gravity),
      searching_(options.from_nothing) {}

void LocatingTracker::Start(const SE3& T_map_body) {
  searching_ = watching_ = false;
  tracker_->Start(T_map_body);
}

void LocatingTracker::Start(const BodyState& state) {
  searching_ = watching_ = false;
  tracker_->Start(state);
}

void LocatingTracker::Start(Utime t, const BodyState& state, const Matrix15d& information) {
  searching_ = watching_ = false;
  tracker_->Start(t, state, information);
}

void LocatingTracker::Search(TrackerMode mode) {
  searching_ = true;
  watching_ = false;
  mode_ = mode;
  lost_since_ = 0;
}

TrackerOutput LocatingTracker::Process(const KeyframeInput& keyframe) {
  time_ = keyframe.t;
  return searching_ ? ProcessSearching(keyframe) : ProcessTracking(keyframe);
}

TrackerOutput LocatingTracker::ProcessTracking(const KeyframeInput& keyframe) {
  TrackerOutput output = tracker_->Process(keyframe);
  if (output.mode == TrackerMode::kLost) {
    WatchLoss(keyframe);
  } else {
    lost_since_ = 0;
  }
  if (watching_) WatchScale(keyframe, &output);
  return output;
}

// Lost, the tracker looks around where it was; after a while all over the map.
void LocatingTracker::WatchLoss(const KeyframeInput& keyframe) {
  if (lost_since_ == 0) {
    lost_since_ = keyframe.t;
    locator_.Restart();
  }
  locator_.AddImu(keyframe);
  if (options_.lost_s >= 0 && ToSeconds(keyframe.t - lost_since_) >= options_.lost_s)
    Search(TrackerMode::kLost);
}

// A place that was found although the map is of another size is no place: there is no pose then.
void LocatingTracker::WatchScale(const KeyframeInput& keyframe, TrackerOutput* output) {
  if (output->mode != TrackerMode::kTracking || !output->has_pose) {
    scale_.Begin();
    return;
  }
  const ScaleWatch::Verdict verdict =
      scale_.Add(keyframe.t, output->nodes.back().state.T_map_body, keyframe.imu);
  if (verdict == ScaleWatch::Verdict::kOpen) return;
  watching_ = false;
  if (verdict == ScaleWatch::Verdict::kAgrees) return;
  locator_.Restart();
  locator_.DoubtScale();
  Search(TrackerMode::kLost);
  const std::string reason = SelfLocator::WrongScale(scale_.fit());
  *output = TrackerOutput();
  output->mode = TrackerMode::kLost;
  output->reason = reason;
}

TrackerOutput LocatingTracker::ProcessSearching(const KeyframeInput& keyframe) {
  if (!keyframe.imu.empty()) rate_ = keyframe.imu.back().gyro;
  locator_.AddKeyframe(keyframe);
  if (const std::optional<BodyState> found = locator_.Found()) {
    searching_ = false;
    watching_ = true;
    scale_.Begin();
    tracker_->Start(*found);
  }
  TrackerOutput output;
  output.mode = mode();
  output.reason = "looking for the place: " + locator_.Progress();
  output.image_speed = MedianImageSpeed(alignment_, far_, SE3(), Eigen::Vector3d::Zero(), rate_);
  return output;
}

}  // namespace evit
