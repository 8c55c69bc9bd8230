#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/localization/place_query.h"
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
  double worth_following = 4;       // significance of what is followed at all
  std::size_t max_hypotheses = 8;   // that are followed at a time
  double again_s = 1;               // after that long without a decision the whole map is searched again
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
  void AddKeyframe(const KeyframeInput& keyframe);

  /// What waits for an answer: null where nothing does.
  const PlaceQuery* question() const { return question_ ? &*question_ : nullptr; }
  /// PlaceFinder::Answer's, to question().
  void AddAnswer(const std::vector<PlaceCandidate>& answer);

  /// Where the body is at the newest keyframe, once that is sure.
  std::optional<BodyState> Found() const;

  /// How far it is, for a person.
  std::string Progress() const;
  /// What is followed, best first: pose and mean significance.
  std::vector<PlaceCandidate> Followed() const;

 private:
  struct Step {
    Utime t;
    SE3 T_map_body;
    double significance;
  };
  struct Hypothesis {
    BodyState state;  // at its last step
    std::vector<Step> steps;
    /// Significance over the newest steps.
    double Mean(std::size_t newest = std::numeric_limits<std::size_t>::max()) const;

    int weak = 0;  // last steps in a row that did not fit
    double likeness = 0;
    int n_points = 0;
  };
  struct View {
    Utime t;
    cv::Mat surface;
  };

  void AskNext();
  void AskEverywhere(const View& view, std::vector<SE3> hypotheses);
  void Follow(const std::vector<PlaceCandidate>& answer);
  void Adopt(const PlaceCandidate& candidate);
  void DropWeak();
  void Decide();
  bool Aligned(const Hypothesis& hypothesis, BodyState* state) const;
  std::vector<ImuSample> ImuBetween(Utime begin, Utime end) const;
  std::size_t Rivals(const Hypothesis& best) const;

  Rig rig_;
  TrackerOptions tracker_;
  SelfLocatorOptions options_;
  std::deque<ImuSample> imu_;  // without holes
  std::deque<View> views_;     // not asked about yet
  std::optional<PlaceQuery> question_;
  std::vector<Hypothesis> hypotheses_;
  Utime last_view_ = 0;  // us: of the newest keyframe that was kept
  Utime searched_ = 0;   // us: keyframe of the last search everywhere; 0: none yet
  std::int64_t asked_ = 0;
  std::optional<Step> found_;
  BodyState found_state_;
  std::string progress_ = "waiting for IMU samples";
};

}  // namespace evit
