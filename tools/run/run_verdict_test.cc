#include "tools/run/run_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::run {
namespace {

using ::testing::HasSubstr;

report::Report Tracked() {
  report::Report report;
  report.set_keyframes(100);
  report.set_final_mode("TRACKING");
  report.set_events(1000);
  return report;
}

TEST(RunVerdict, TrackingToTheEndIsASuccess) { EXPECT_EQ(FailureOf(Tracked(), "", 0.9, {}), ""); }

TEST(RunVerdict, PosesForLessThanHalfOfTheTimeAreAFailure) {
  EXPECT_EQ(FailureOf(Tracked(), "", 0.51, {}), "");
  EXPECT_THAT(FailureOf(Tracked(), "", 0.49, {}), HasSubstr("only 49 %"));
}

TEST(RunVerdict, BeingLostAtTheEndIsAFailureWithItsReason) {
  report::Report report = Tracked();
  report.set_final_mode("LOST");
  EXPECT_EQ(FailureOf(report, "no events", 0.9, {}), "LOST at the end: no events");
}

TEST(RunVerdict, NoKeyframeIsAFailure) {
  EXPECT_THAT(FailureOf(report::Report(), "frame_builder: starting", 0, {}),
              HasSubstr("frame_builder: starting"));
}

TEST(RunVerdict, MoreThanATwentiethOutOfTimeIsAFailure) {
  report::Report report = Tracked();
  report::Service* service = report.add_services();
  service->set_name("frame_builder");
  auto& counters = *service->mutable_counters();
  counters["events.late"] = 30;
  counters["events.ahead"] = 19;
  EXPECT_EQ(FailureOf(report, "", 0.9, UntimelyOf(report)), "");
  counters["events.ahead"] = 21;
  EXPECT_THAT(FailureOf(report, "", 0.9, UntimelyOf(report)), HasSubstr("out of order"));
}

TEST(RunVerdict, WhatASecondSenderSentSpoilsAResult) {
  report::Report report = Tracked();
  report::Service* service = report.add_services();
  service->set_name("frame_builder");
  (*service->mutable_counters())["EVENTS.two_senders"] = 2;
  EXPECT_EQ(FailureOf(report, "", 0.9, {}), "");
  (*service->mutable_counters())["EVENTS.two_senders"] = 3;
  EXPECT_THAT(FailureOf(report, "", 0.9, {}), HasSubstr("two senders on EVENTS"));
  report.set_final_mode("LOST");  // as it may be because of that
  EXPECT_THAT(FailureOf(report, "", 0.9, {}), HasSubstr("two senders on EVENTS"));
}

TEST(RunVerdict, PosesMoreThanHalfASecondApartDoNotCoverTheTimeBetween) {
  const Trajectory poses = {{0, SE3()}, {400'000, SE3()}, {1'400'000, SE3()}, {1'500'000, SE3()}};
  EXPECT_DOUBLE_EQ(TrackedShare(poses, 2), 0.25);
}

}  // namespace
}  // namespace evit::run
