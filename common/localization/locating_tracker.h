#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/localization/scale_watch.h"
#include "common/localization/self_locator.h"
#include "common/tracking/map_tracker.h"

namespace evit {

/// A tracker that needs no start pose: until it knows where it is, and again when it has been lost for a
/// while, keyframes go to a SelfLocator; once that is sure, to the tracker. Before that there is no pose.
class LocatingTracker final : public MapTracker {
 public:
  struct Options {
    SelfLocatorOptions search;
    bool from_nothing = true;  // else `tracker` has a start pose
    /// s: time in LOST before the whole map is searched; negative: never
    double lost_s = 1;
  };
  LocatingTracker(std::unique_ptr<MapTracker> tracker, const Rig& rig, const TrackerOptions& tracker_options,
                  const Options& options);

  void Start(const SE3& T_map_body) override;
  void Start(const BodyState& state) override;
  void Start(Utime t, const BodyState& state, const Matrix15d& information) override;
  VisibilityQuery NextQuery() const override { return tracker_->NextQuery(); }
  VisibilityQuery QueryAfter(const KeyframeInput& keyframe) const override {
    return tracker_->QueryAfter(keyframe);
  }
  VisibilityQuery QueryBeyond(const KeyframeInput& keyframe) const override {
    return tracker_->QueryBeyond(keyframe);
  }
  bool Suffices(const VisibilityQuery& answered, const VisibilityQuery& query) const override {
    return !searching_ && tracker_->Suffices(answered, query);
  }
  void AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) override {
    tracker_->AddVisible(ids, points);
  }
  void ForgetPoints() override { tracker_->ForgetPoints(); }
  TrackerOutput Process(const KeyframeInput& keyframe) override;
  void set_point_share(double share) override { tracker_->set_point_share(share); }
  void set_solve_budget(double seconds) override { tracker_->set_solve_budget(seconds); }
  TrackerMode mode() const override { return searching_ ? mode_ : tracker_->mode(); }
  const BodyState& state() const override { return tracker_->state(); }
  Utime state_time() const override { return searching_ ? time_ : tracker_->state_time(); }
  const Eigen::Vector3d& rate() const override { return searching_ ? rate_ : tracker_->rate(); }

  const PlaceQuery* PlaceQuestion() const override { return searching_ ? locator_.question() : nullptr; }
  void SetPlacePrior(const PlacePrior& prior) override { locator_.SetPrior(prior); }
  void AddPlaces(const std::vector<PlaceCandidate>& places) override { locator_.AddAnswer(places); }
  /// How far the search is, for a person.
  std::string Progress() const { return locator_.Progress(); }

 private:
  void Search(TrackerMode mode);
  TrackerOutput ProcessTracking(const KeyframeInput& keyframe);
  void WatchLoss(const KeyframeInput& keyframe);
  void WatchScale(const KeyframeInput& keyframe, TrackerOutput* output);
  TrackerOutput ProcessSearching(const KeyframeInput& keyframe);

  std::unique_ptr<MapTracker> tracker_;
  SelfLocator locator_;
  Options options_;
  AlignmentSettings alignment_;
  AlignmentPoints far_;  // points all over the image, to tell how fast it moves by the gyro
  ScaleWatch scale_;
  bool watching_ = false;  // the scale, after a start without a pose
  bool searching_;
  TrackerMode mode_ = TrackerMode::kBootstrapping;  // while searching
  Utime time_ = 0;                                  // us: of the newest keyframe
  Utime lost_since_ = 0;                            // us; 0: not lost
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // rad/s, body frame
};

}  // namespace evit
