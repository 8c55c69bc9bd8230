#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/localization/followed_places.h"
#include "common/localization/motion_fit.h"
#include "common/localization/place_query.h"
#include "common/localization/recent_imu.h"
#include "common/localization/search_schedule.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/state.h"
#include "common/tracking/tracker_options.h"

namespace evit {

struct SelfLocatorOptions {
  PlacePrior prior;
  double up_s = 3;                  // of IMU samples at most that tell which way is up
  double least_up_s = 0.5;          // of them, before the first question
  double step_ms = 50;              // between keyframes that hypotheses are followed over
  double follow_s = 0.5;            // that a hypothesis must explain
  int least_steps = 8;              // in that time
  double least_turn = 0.05;         // rad: of the view, by turning and moving, in that time
  double least_significance = 6;    // of one that counts as found, mean over its keyframes
  double patient_significance = 5;  // the same, once it has been followed for twice as long
  double least_lead = 2;            // by which it is ahead of any other, in the same keyframes
  double patient_lead = 1.5;        // the same, once it has been followed for twice as long
  double worth_following = 4;       // significance of what is followed at all
  std::size_t max_hypotheses = 8;   // that are followed at a time
  bool other_verticals = true;      // are tried where the likeliest leads to no place
  double again_s = 1;               // without a decision, after which the whole map is searched again
};

/// Finds out where it is without being told: asks where a keyframe may have been seen (PlaceQuery), moves the
/// answers along with the IMU, has each fitted to the next keyframes, and believes the one that alone
/// explains them for long enough, and that the accelerometer agrees with.
///
/// Knows nothing of who answers and when. Answers may be late, as long as it holds the keyframes since (3 s).
class SelfLocator {
 public:
  SelfLocator(const Rig& rig, const TrackerOptions& tracker, const SelfLocatorOptions& options = {});

  /// Begins from nothing.
  void Restart();
  /// Takes a keyframe's IMU samples only, so that a search that begins later knows at once which way is up.
  void AddImu(const KeyframeInput& keyframe);
  void AddKeyframe(const KeyframeInput& keyframe);

  /// What is known of the place, from now on: what is followed and cannot be is given up.
  void SetPrior(const PlacePrior& prior);
  /// The map's size is not to be trusted: from now on a place counts as found only once the accelerometer
  /// says that it fits.
  void DoubtScale() { doubts_scale_ = true; }
  /// What is wrong with a map that moves so, for a person.
  static std::string WrongScale(const MotionFit& fit);

  /// What waits for an answer: null where nothing does.
  const PlaceQuery* question() const { return question_ ? &*question_ : nullptr; }
  /// PlaceFinder::Answer's, to question().
  void AddAnswer(const std::vector<PlaceCandidate>& answer);

  /// Where the body is at the newest keyframe, once that is sure.
  std::optional<BodyState> Found() const;

  /// How far it is, for a person.
  std::string Progress() const;

 private:
  struct View {
    Utime t;
    cv::Mat surface;
  };

  void AskNext();
  void AskEverywhere(const View& view, std::vector<SE3> hypotheses);
  bool ToCompare() const;
  void AskForPlacesLikeTheBest(const View& view, std::vector<SE3> hypotheses);
  std::string Searched() const;  // "the map", or the part of it that the prior leaves
  bool Convinced() const;
  void Decide();
  std::string WhatDisagrees(const std::optional<MotionFit>& fit) const;
  bool Aligned(const std::vector<FollowedPlace::Step>& steps, const std::vector<std::size_t>& fitting,
               BodyState* state) const;
  FollowedPlaces::ImuBetween Imu() const;

  Rig rig_;
  TrackerOptions tracker_;
  SelfLocatorOptions options_;
  RecentImu imu_;
  std::deque<View> views_;  // not asked about yet
  std::optional<PlaceQuery> question_;
  bool comparing_ = false;  // it is about places that look like the best one
  FollowedPlaces places_;
  View newest_{0, {}};  // of all that were kept; t 0: none
  SearchSchedule searches_;
  std::int64_t asked_ = 0;
  bool doubts_scale_ = false;
  Utime found_at_ = 0;  // us; 0: not found
  BodyState found_;     // then
  std::string progress_ = "waiting for IMU samples";
};

}  // namespace evit
