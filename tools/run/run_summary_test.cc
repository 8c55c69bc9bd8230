#include "tools/run/run_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::run {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

RunJob Room() {
  RunJob job;
  job.log = "a/room.lcmlog", job.rig = "rig.textproto", job.map = "map.pcd";
  return job;
}

report::Report LostTimes(int times) {
  report::Report report;
  report.set_sequence_s(12);
  report.set_coverage(0.613);
  report.set_times_lost(times);
  report.set_lost_share(0.347);
  report.set_last_loss("biases too large");
  return report;
}

const Trajectory kOnePose = {{0, SE3()}};

TEST(RunSummary, SaysHowOftenItWasLostAndWhatToAsk) {
  EXPECT_EQ(LossesText(Room(), LostTimes(29)),
            "LOST 29 times, 35 % of the time (last: biases too large); what may be wrong: evit doctor --log "
            "a/room.lcmlog --rig rig.textproto --map map.pcd");
  EXPECT_THAT(LossesText(Room(), LostTimes(1)), HasSubstr("LOST once, 35 %"));
  EXPECT_EQ(LossesText(Room(), LostTimes(0)), "");
}

TEST(RunSummary, ItsFirstLineAndThePictureHaveCoverageAndLosses) {
  EXPECT_THAT(RunTitle(Room(), LostTimes(29), kOnePose),
              AllOf(HasSubstr("room: poses for 61 % of the sequence"), HasSubstr(", LOST 29 times")));
  EXPECT_THAT(RunTitle(Room(), LostTimes(0), kOnePose), Not(HasSubstr("LOST")));
  EXPECT_EQ(RunTitle(Room(), LostTimes(29), {}), "room: no pose");
}

}  // namespace
}  // namespace evit::run
