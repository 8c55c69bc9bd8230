#include "tools/run/run_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::run {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

report::Report Tracked() {
  report::Report report;
  report.set_keyframes(100);
  report.set_poses(90);
  report.set_final_mode("TRACKING");
  report.set_events(1000);
  report.set_coverage(0.9);
  return report;
}

TEST(RunVerdict, TrackingToTheEndIsASuccess) { EXPECT_EQ(FailureOf(Tracked(), "", {}), ""); }

TEST(RunVerdict, PosesForLessThanHalfOfTheTimeAreAFailure) {
  report::Report report = Tracked();
  report.set_coverage(0.51);
  EXPECT_EQ(FailureOf(report, "", {}), "");
  report.set_coverage(0.49);
  EXPECT_THAT(FailureOf(report, "", {}), HasSubstr("only 49 %"));
}

TEST(RunVerdict, BeingLostAtTheEndIsAFailureWithItsReason) {
  report::Report report = Tracked();
  report.set_final_mode("LOST");
  EXPECT_EQ(FailureOf(report, "no events", {}), "LOST at the end: no events");
}

TEST(RunVerdict, AStartThatWasNeverFoundNamesWhatMayBeWrong) {
  report::Report report = Tracked();
  report.set_poses(0);
  report.set_final_mode("BOOTSTRAPPING");
  EXPECT_THAT(FailureOf(report, "places followed: 2", {}),
              AllOf(HasSubstr("BOOTSTRAPPING at the end: places followed: 2; the start was never found"),
                    HasSubstr("another place"), HasSubstr("inverted"), HasSubstr("IMU of another clip"),
                    HasSubstr("docs/troubleshooting.md")));
}

TEST(RunVerdict, NoKeyframeIsAFailure) {
  EXPECT_THAT(FailureOf(report::Report(), "frame_builder: starting", {}),
              HasSubstr("frame_builder: starting"));
}

TEST(RunVerdict, MoreThanATwentiethOutOfTimeIsAFailure) {
  report::Report report = Tracked();
  report::Service* service = report.add_services();
  service->set_name("frame_builder");
  auto& counters = *service->mutable_counters();
  counters["events.late"] = 30;
  counters["events.ahead"] = 19;
  EXPECT_EQ(FailureOf(report, "", UntimelyOf(report)), "");
  counters["events.ahead"] = 21;
  EXPECT_THAT(FailureOf(report, "", UntimelyOf(report)), HasSubstr("out of order"));
}

TEST(RunVerdict, WhatASecondSenderSentSpoilsAResult) {
  report::Report report = Tracked();
  report::Service* service = report.add_services();
  service->set_name("frame_builder");
  (*service->mutable_counters())["EVENTS.two_senders"] = 2;
  EXPECT_EQ(FailureOf(report, "", {}), "");
  (*service->mutable_counters())["EVENTS.two_senders"] = 3;
  EXPECT_THAT(FailureOf(report, "", {}), HasSubstr("two senders on EVENTS"));
  report.set_final_mode("LOST");  // as it may be because of that
  EXPECT_THAT(FailureOf(report, "", {}), HasSubstr("two senders on EVENTS"));
}

}  // namespace
}  // namespace evit::run
