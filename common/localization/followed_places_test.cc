#include "common/localization/followed_places.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

constexpr Utime kBetween = 50'000;

// At rest: the IMU feels gravity.
std::vector<ImuSample> Still(Utime begin, Utime end) {
  std::vector<ImuSample> samples;
  for (Utime t = begin; t <= end; t += 5000) {
    ImuSample sample;
    sample.t = t;
    sample.accel = {0, 0, 9.81};
    samples.push_back(sample);
  }
  return samples;
}

PlaceCandidate At(double x, double significance) {
  return {SE3(Eigen::Quaterniond::Identity(), {x, 0, 0}), significance, 0, 500};
}

// What comes from elsewhere into the right one's valley brings a history that does not go with the motion.
TEST(FollowedPlaces, OfTwoThatMeetTheOneThatFittedAllTheWayStays) {
  FollowedPlaces places(9.81, 8, 4);
  Utime t = 1'000'000;
  places.AddAnswer(t, 0, {At(0, 7.5), At(0.4, 4.5)}, false);
  for (int k = 0; k < 5; ++k) {
    t += kBetween;
    ASSERT_EQ(places.MoveTo(t, Still).size(), 2U);
    const bool first_is_right = places.all()[0].state.T_map_body.p.x() < 0.2;
    places.AddAnswer(t, 2,
                     {first_is_right ? At(0, 7.5) : At(0.4, 4.5), first_is_right ? At(0.4, 4.5) : At(0, 7.5)},
                     false);
  }
  t += kBetween;
  places.MoveTo(t, Still);
  places.AddAnswer(t, 2, {At(0, 7.4), At(0, 7.6)},
                   false);  // the wrong one has jumped, and fits a little better now
  ASSERT_EQ(places.all().size(), 1U);
  EXPECT_NEAR(places.Best().steps.front().T_map_body.p.x(), 0, 0.01);
  EXPECT_GT(places.Best().Mean(), 7);
}

TEST(FollowedPlaces, OfTwoThatFittedAlikeTheOneFollowedForLongerStays) {
  FollowedPlaces places(9.81, 8, 4);
  places.AddAnswer(1'000'000, 0, {At(0, 7)}, false);
  for (int k = 1; k < 4; ++k) {
    places.MoveTo(1'000'000 + k * kBetween, Still);
    places.AddAnswer(1'000'000 + k * kBetween, 1, {At(0, 7)}, false);
  }
  places.MoveTo(1'000'000 + 4 * kBetween, Still);
  places.AddAnswer(1'000'000 + 4 * kBetween, 1, {At(0, 7), At(0.2, 7.2)}, false);
  ASSERT_EQ(places.all().size(), 2U);
  places.MoveTo(1'000'000 + 5 * kBetween, Still);
  places.AddAnswer(1'000'000 + 5 * kBetween, 2, {At(0, 7), At(0, 7.1)}, false);
  ASSERT_EQ(places.all().size(), 1U);
  EXPECT_EQ(places.Best().steps.size(), 6U);
}

TEST(FollowedPlaces, WhatDoesNotFitTwiceIsDropped) {
  FollowedPlaces places(9.81, 8, 4);
  places.AddAnswer(1'000'000, 0, {At(0, 5), At(1, 3.9)}, false);
  ASSERT_EQ(places.all().size(), 1U);  // 3.9 is not worth following
  for (int k = 1; k <= 2; ++k) {
    places.MoveTo(1'000'000 + k * kBetween, Still);
    places.AddAnswer(1'000'000 + k * kBetween, 1, {At(0, 2)}, false);
  }
  EXPECT_TRUE(places.empty());
}

}  // namespace
}  // namespace evit
