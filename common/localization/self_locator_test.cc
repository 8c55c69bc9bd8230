#include "common/localization/self_locator.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/localization/locating_tracker.h"
#include "tests/helpers/synthetic_room.h"

namespace evit {
namespace {

constexpr Utime kStep = 50'000;

// A body in one room, whose events are answered from the map of another or the same.
class SelfLocatorTest : public ::testing::Test {
 protected:
  KeyframeInput Keyframe(const PointMap& seen, Utime t, bool first) const {
    KeyframeInput keyframe;
    keyframe.t = t;
    keyframe.seq = t / kStep;
    keyframe.n_events = 5000;
    keyframe.surface = synthetic::SeenFrom(seen, motion_.PoseAt(ToSeconds(t)));
    if (!first) keyframe.imu = motion_.Samples(t - kStep, t, {});
    keyframe.imu_gap = 5000;
    return keyframe;
  }
  // Time until found, s; negative: not within `seconds`.
  double Locate(const PointMap& seen, const synthetic::IndexedRoom& room, double seconds,
                const SelfLocatorOptions& options = {}) {
    locator_.emplace(synthetic::IndexedRoom::TestRig(), TrackerOptions(), options);
    if (doubts_scale_) locator_->DoubtScale();
    const Utime begin = 1'000'000, end = begin + static_cast<Utime>(seconds * 1e6);
    for (now_ = begin; now_ <= end; now_ += kStep) {
      locator_->AddKeyframe(Keyframe(seen, now_, now_ == begin));
      while (const PlaceQuery* question = locator_->question())
        locator_->AddAnswer(room.finder.Answer(*question));
      if (locator_->Found()) return ToSeconds(now_ - begin);
    }
    return -1;
  }

  synthetic::MotionInRoom motion_;
  std::optional<SelfLocator> locator_;
  Utime now_ = 0;
  bool doubts_scale_ = false;
};

TEST_F(SelfLocatorTest, FindsItselfWithinTwoSeconds) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  motion_.about = {-0.3, 0.5, 0.1};
  motion_.heading = 2.5;
  const double after = Locate(map, room, 2);
  EXPECT_GE(after, 0.9);  // half a second for the vertical, half a second of parallax
  ASSERT_LT(after, 2);
  const SE3 truth = motion_.PoseAt(ToSeconds(now_));
  const BodyState found = *locator_->Found();
  EXPECT_LT((found.T_map_body.p - truth.p).norm(), 0.02);
  EXPECT_LT(AngularDistance(found.T_map_body.q, truth.q), 0.02);
  const Eigen::Vector3d velocity = ExpSO3({0, 0, motion_.heading}) * motion_.State(ToSeconds(now_)).velocity;
  EXPECT_LT((found.velocity - velocity).norm(), 0.1);
}

TEST_F(SelfLocatorTest, InAnotherRoomItClaimsNothing) {
  EXPECT_LT(Locate(synthetic::TheRoom().index.map(), synthetic::OtherRoom(), 2), 0);
}

TEST_F(SelfLocatorTest, TwoPlacesThatLookAlikeAreAmbiguous) {
  const synthetic::IndexedRoom& room = synthetic::TwoSidedRoom();
  const PointMap& map = room.index.map();
  motion_.about = {0.3, 0.2, 0};
  EXPECT_LT(Locate(map, room, 1.5), 0);
  EXPECT_EQ(locator_->Progress(), "ambiguous: 2 places look alike");
  PlacePrior compass;
  compass.heading = {0, 1};
  locator_->SetPrior(compass);  // in the middle of the search: one of the two is given up
  for (const Utime end = now_ + 1'500'000; now_ <= end && !locator_->Found(); now_ += kStep) {
    locator_->AddKeyframe(Keyframe(map, now_, false));
    while (const PlaceQuery* question = locator_->question())
      locator_->AddAnswer(room.finder.Answer(*question));
  }
  EXPECT_TRUE(locator_->Found());
  SelfLocatorOptions known;
  known.prior.heading = {0, 1};
  EXPECT_GT(Locate(map, room, 1.5, known), 0);
}

TEST_F(SelfLocatorTest, FourPlacesThatLookAlikeAreAmbiguous) {
  const synthetic::IndexedRoom& room = synthetic::FourSidedRoom();
  motion_.about = {0.3, 0.2, 0};
  EXPECT_LT(Locate(room.index.map(), room, 1.5), 0);
  EXPECT_EQ(locator_->Progress(), "ambiguous: 4 places look alike");
}

// A search shows only the first of two places that look alike; nothing is claimed before the map has been
// asked for the other.
TEST_F(SelfLocatorTest, BeforeItClaimsAPlaceItLooksForOthersLikeIt) {
  const synthetic::IndexedRoom& room = synthetic::TwoSidedRoom();
  motion_.about = {0.3, 0.2, 0};
  locator_.emplace(synthetic::IndexedRoom::TestRig(), TrackerOptions());
  bool compared = false;
  for (now_ = 1'000'000; now_ <= 2'500'000; now_ += kStep) {
    locator_->AddKeyframe(Keyframe(room.index.map(), now_, now_ == 1'000'000));
    while (const PlaceQuery* question = locator_->question()) {
      std::vector<PlaceCandidate> answer = room.finder.Answer(*question);
      if (question->everywhere && question->hypotheses.empty()) answer.resize(1);
      compared = compared || (question->everywhere && !question->hypotheses.empty());
      locator_->AddAnswer(answer);
    }
  }
  EXPECT_TRUE(compared);
  EXPECT_FALSE(locator_->Found());
  EXPECT_EQ(locator_->Progress(), "ambiguous: 2 places look alike");
}

// Where a place fits badly, the finder does not look for others like it: the question does not count.
TEST_F(SelfLocatorTest, AComparisonInAKeyframeThatThePlaceFitsBadlyDoesNotCount) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  locator_.emplace(synthetic::IndexedRoom::TestRig(), TrackerOptions());
  for (now_ = 1'000'000; now_ <= 2'500'000; now_ += kStep) {
    locator_->AddKeyframe(Keyframe(room.index.map(), now_, now_ == 1'000'000));
    while (const PlaceQuery* question = locator_->question()) {
      std::vector<PlaceCandidate> answer = room.finder.Answer(*question);
      for (std::size_t k = 0; question->everywhere && k < question->hypotheses.size(); ++k)
        answer[k].significance = std::min(answer[k].significance, 4.9);
      locator_->AddAnswer(answer);
    }
  }
  EXPECT_FALSE(locator_->Found());
  EXPECT_EQ(locator_->Progress(), "a place fits; comparing it with the rest of the map");
}

TEST_F(SelfLocatorTest, AtRestItDoesNotDecide) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  motion_.amplitude = motion_.turn = 0;
  EXPECT_LT(Locate(map, room, 1.5), 0);
}

TEST_F(SelfLocatorTest, AMapInCentimetresIsNotBelieved) {
  const PointMap& map = synthetic::TheRoom().index.map();
  for (const float unit : {100.0F, 0.01F}) {
    PointMap scaled = map;
    for (Eigen::Vector3f& p : scaled.points) p *= unit;
    EXPECT_LT(Locate(map, synthetic::IndexedRoom(scaled), 1.5), 0);
  }
}

TEST_F(SelfLocatorTest, WhereTheMapsSizeIsInDoubtTheAccelerometerHasTheLastWord) {
  const PointMap& map = synthetic::TheRoom().index.map();
  PointMap larger = map;
  for (Eigen::Vector3f& p : larger.points) p *= 1.5F;
  const synthetic::IndexedRoom room(larger);
  doubts_scale_ = true;
  EXPECT_LT(Locate(map, room, 3), 0);
  EXPECT_GT(Locate(map, synthetic::TheRoom(), 3), 0);
}

TEST_F(SelfLocatorTest, PosesThatTheAccelerometerContradictsAreNotBelieved) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  motion_.gravity = 12;  // a rig that says 9.81: as a wrong scale of the sensor, or a map that is not upright
  EXPECT_LT(Locate(room.index.map(), room, 1.5), 0);
}

TEST_F(SelfLocatorTest, AnswersMayComeLate) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  locator_.emplace(synthetic::IndexedRoom::TestRig(), TrackerOptions());
  Utime asked = 0;
  for (now_ = 1'000'000; now_ <= 3'500'000 && !locator_->Found(); now_ += kStep) {
    locator_->AddKeyframe(Keyframe(map, now_, now_ == 1'000'000));
    if (asked == 0 && locator_->question() != nullptr) asked = now_;
    if (asked == 0 || now_ < asked + 800'000) continue;  // the first search takes 0.8 s
    while (const PlaceQuery* question = locator_->question())
      locator_->AddAnswer(room.finder.Answer(*question));
  }
  ASSERT_TRUE(locator_->Found());
  EXPECT_LE(now_, 2'600'000);  // it has caught up on the keyframes since
  EXPECT_LT((locator_->Found()->T_map_body.p - motion_.PoseAt(ToSeconds(now_ - kStep)).p).norm(), 0.03);
}

TEST_F(SelfLocatorTest, NobodyWhoAnswersIsNoHarm) {
  locator_.emplace(synthetic::IndexedRoom::TestRig(), TrackerOptions());
  const PointMap map = synthetic::WalledRoom(1);
  std::int64_t asked = 0;
  for (now_ = 1'000'000; now_ <= 9'000'000; now_ += kStep) {
    locator_->AddKeyframe(Keyframe(map, now_, now_ == 1'000'000));
    if (const PlaceQuery* question = locator_->question()) asked = question->number;
  }
  EXPECT_GE(asked, 2);  // of another keyframe, once the first was too old
  EXPECT_LE(asked, 4);
  EXPECT_FALSE(locator_->Found());
}

TEST_F(SelfLocatorTest, ATrackerWithoutAPoseStartsWhereItFindsItself) {
  const synthetic::IndexedRoom& room = synthetic::TheRoom();
  const PointMap& map = room.index.map();
  const Rig rig = synthetic::IndexedRoom::TestRig();
  LocatingTracker tracker(MakeTracker(rig, {}, SE3()), rig, {}, {});
  bool asked = false;
  for (now_ = 1'000'000; now_ <= 3'000'000 && !(asked && tracker.state_time() == 0); now_ += kStep) {
    const TrackerOutput output = tracker.Process(Keyframe(map, now_, now_ == 1'000'000));
    EXPECT_FALSE(output.has_pose);
    EXPECT_EQ(output.mode, TrackerMode::kBootstrapping);
    while (const PlaceQuery* question = tracker.PlaceQuestion()) {
      asked = true;
      tracker.AddPlaces(room.finder.Answer(*question));
    }
  }
  now_ -= kStep;  // of the last keyframe
  EXPECT_LT((tracker.state().T_map_body.p - motion_.PoseAt(ToSeconds(now_)).p).norm(), 0.03);
}

}  // namespace
}  // namespace evit
