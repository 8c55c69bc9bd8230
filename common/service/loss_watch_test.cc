#include "common/service/loss_watch.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

TEST(LossWatchTest, NamesWhatIsBeingLostAndForgets) {
  LossWatch watch;
  std::map<std::string, std::int64_t> counters{{"EVENTS.received", 1000},
                                               {"EVENTS.lost", 2},
                                               {"IMU.received", 200},
                                               {"IMU.lost", 0},
                                               {"mode.lost", 50}};
  EXPECT_EQ(watch.Look(counters), "");
  counters["EVENTS.received"] += 800;
  counters["EVENTS.lost"] += 200;
  counters["IMU.received"] += 200;
  EXPECT_EQ(watch.Look(counters).substr(0, 24), "10 % of EVENTS get lost:");  // 202 of 2002
  counters["EVENTS.received"] += 1000;
  counters["IMU.lost"] += 20;
  counters["IMU.received"] += 180;
  const std::string both = watch.Look(counters);
  EXPECT_EQ(both.substr(0, 33), "10 % of EVENTS, 5 % of IMU get lo") << both;
  counters["EVENTS.received"] += 1000;
  counters["IMU.received"] += 200;
  EXPECT_EQ(watch.Look(counters).substr(0, 20), "5 % of IMU get lost:");
  EXPECT_EQ(watch.Look(counters), "");
}

TEST(LossWatchTest, BearsNumbersThatAForgerChose) {
  LossWatch watch;
  const std::string said = watch.Look({{"EVENTS.received", 2}, {"EVENTS.lost", std::int64_t{1} << 60}});
  EXPECT_EQ(said.substr(0, 25), "100 % of EVENTS get lost:");
}

}  // namespace
}  // namespace evit
