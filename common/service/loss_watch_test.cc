#include "common/service/loss_watch.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

std::string TextAfter(LossWatch* watch, const std::map<std::string, std::int64_t>& counters) {
  watch->Update(counters);
  return watch->text();
}

TEST(LossWatchTest, NamesWhatIsBeingLostAndForgets) {
  LossWatch watch;
  std::map<std::string, std::int64_t> counters{{"EVENTS.received", 1000},
                                               {"EVENTS.lost", 2},
                                               {"IMU.received", 200},
                                               {"IMU.lost", 0},
                                               {"mode.lost", 50}};
  EXPECT_EQ(TextAfter(&watch, counters), "");
  counters["EVENTS.received"] += 800;
  counters["EVENTS.lost"] += 200;
  counters["IMU.received"] += 200;
  EXPECT_EQ(TextAfter(&watch, counters).substr(0, 24), "10 % of EVENTS get lost:");  // 202 of 2002
  counters["EVENTS.received"] += 1000;
  counters["IMU.lost"] += 20;
  counters["IMU.received"] += 180;
  const std::string both = TextAfter(&watch, counters);
  EXPECT_EQ(both.substr(0, 33), "10 % of EVENTS, 5 % of IMU get lo") << both;
  counters["EVENTS.received"] += 1000;
  counters["IMU.received"] += 200;
  EXPECT_EQ(TextAfter(&watch, counters).substr(0, 20), "5 % of IMU get lost:");
  EXPECT_EQ(TextAfter(&watch, counters), "");
}

TEST(LossWatchTest, BearsNumbersThatAForgerChose) {
  LossWatch watch;
  const std::string said =
      TextAfter(&watch, {{"EVENTS.received", 2}, {"EVENTS.lost", std::int64_t{1} << 60}});
  EXPECT_EQ(said.substr(0, 25), "100 % of EVENTS get lost:");
}

TEST(LossWatchTest, SaysWhatSendersDoWrong) {
  LossWatch watch;
  EXPECT_EQ(TextAfter(&watch, {{"EVENTS.two_senders", 2}, {"IMU.unnumbered", 0}}), "");
  EXPECT_NE(TextAfter(&watch, {{"EVENTS.two_senders", 3}}).find("two senders on EVENTS"), std::string::npos);
  EXPECT_NE(
      TextAfter(&watch, {{"EVENTS.unnumbered", 9}, {"IMU.unnumbered", 9}}).find("EVENTS, IMU not numbered"),
      std::string::npos);
}

}  // namespace
}  // namespace evit
