#include "common/tracking/feedback.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

TEST(Feedback, HoldsWhatTheTrackerSays) {
  TrackerOutput output;
  output.mode = TrackerMode::kTracking;
  output.image_speed = 321;
  output.useful_interval = 27'000;
  const TrackerFeedback feedback = FeedbackOf(output);
  EXPECT_EQ(feedback.mode, TrackerFeedback::Mode::kTracking);
  EXPECT_EQ(feedback.image_speed, 321);
  EXPECT_EQ(feedback.useful_interval, 27'000);
  EXPECT_EQ(feedback.keyframe_stride, 1);
}

TEST(Feedback, ModesAreThoseOfTheMessage) {
  TrackerOutput output;
  EXPECT_EQ(FeedbackOf(output).mode, TrackerFeedback::Mode::kBootstrapping);
  output.mode = TrackerMode::kLost;
  EXPECT_EQ(FeedbackOf(output).mode, TrackerFeedback::Mode::kLost);
}

}  // namespace
}  // namespace evit
