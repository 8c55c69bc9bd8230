#include "common/events/feedback_schedule.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

TrackerFeedback WithSpeed(double speed) {
  TrackerFeedback feedback;
  feedback.image_speed = speed;
  return feedback;
}

TEST(FeedbackSchedule, LosslessUsesTheAnswerToTheKeyframeBeforeTheLast) {
  FeedbackSchedule schedule(true);
  ASSERT_NE(schedule.For(1), nullptr);
  EXPECT_EQ(schedule.For(1)->image_speed, 0);
  EXPECT_EQ(schedule.For(2), nullptr);
  schedule.Set(1, WithSpeed(1));
  EXPECT_EQ(schedule.For(2), nullptr);
  schedule.Set(0, WithSpeed(5));
  ASSERT_NE(schedule.For(2), nullptr);
  EXPECT_EQ(schedule.For(2)->image_speed, 5);
}

TEST(FeedbackSchedule, AnswersOfNoMoreUseAreForgotten) {
  FeedbackSchedule schedule(true);
  for (int k = 0; k < 5; ++k) schedule.Set(k, WithSpeed(k));
  schedule.ForgetBefore(5);
  EXPECT_EQ(schedule.For(4), nullptr);
  EXPECT_EQ(schedule.For(5)->image_speed, 3);
  schedule.Set(2, WithSpeed(7));  // late
  EXPECT_EQ(schedule.For(4), nullptr);
}

TEST(FeedbackSchedule, RealTimeUsesTheNewestAnswer) {
  FeedbackSchedule schedule(false);
  schedule.Set(7, WithSpeed(1));
  schedule.Set(3, WithSpeed(2));
  EXPECT_EQ(schedule.For(100)->image_speed, 2);
}

}  // namespace
}  // namespace evit
