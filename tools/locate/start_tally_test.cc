#include "tools/locate/start_tally.h"

#include <gtest/gtest.h>

namespace evit::locate {
namespace {

LocatorResult Result(bool found, double after_s) {
  LocatorResult result;
  result.found = found;
  result.after_s = after_s;
  result.search_s = 0.25;
  result.cpu_s = 1.5;
  result.events_per_s = 2e5;
  result.candidates.resize(3);
  return result;
}

TEST(StartTallyTest, CountsWhatIsRightSoonWrongAndWithdrawn) {
  StartTally tally;
  tally.Add(Result(true, 1.5), true, Claim::kRight);
  tally.Add(Result(true, 2.5), true, Claim::kWrong);
  LocatorResult cut = Result(false, 2);
  cut.cut = true;
  tally.Add(cut, false, Claim::kWrong);
  LocatorResult withdrawn = Result(true, 1.75);
  withdrawn.withdrawn = "lost";
  tally.Add(withdrawn, false);
  EXPECT_EQ(tally.wrong(), 1);
  EXPECT_EQ(tally.Line(),
            "starts 4 right 2 within_2s 1 wrong 1 withdrawn 1 cut 1 after_s 1.75 candidates 3.0 events_per_s "
            "200000 search_s 0.25 "
            "cpu_s 1.50 at_once_right 1 at_once_wrong 2");
}

TEST(StartTallyTest, NoStartIsNoDivisionByZero) {
  EXPECT_EQ(
      StartTally().Line(),
      "starts 0 right 0 within_2s 0 wrong 0 withdrawn 0 cut 0 after_s 0.00 candidates 0.0 events_per_s 0 "
      "search_s 0.00 "
      "cpu_s 0.00 at_once_right 0 at_once_wrong 0");
}

}  // namespace
}  // namespace evit::locate
