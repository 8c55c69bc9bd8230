#include "tools/formats/import/drop_counts.h"

#include <gtest/gtest.h>

#include "tools/formats/import/event_filter.h"

namespace evit::formats {
namespace {

TEST(DropCounts, TextListsReasonsAndIsEmptyWithoutDrops) {
  EXPECT_EQ(DropText({}, "events"), "");
  EXPECT_EQ(DropText({3, 0, 0}, "events"), "3 events dropped: 3 not later than the one before");
  EXPECT_EQ(
      DropText({0, 1, 9}, "events"),
      "10 events dropped: 1 not a number, or no rotation, 9 outside the sensor (is the image size right?)");
}

TEST(DropCounts, AFilterKeepsWhatIsInOrderAndOnTheSensor) {
  EventFilter filter(4, 3);
  EXPECT_TRUE(filter.Keep(-5, 0, 0));
  EXPECT_TRUE(filter.Keep(-5, 3, 2));   // events may share a microsecond
  EXPECT_FALSE(filter.Keep(90, 4, 0));  // an event that is dropped does not move the clock
  EXPECT_FALSE(filter.Keep(90, 0, 3));
  EXPECT_FALSE(filter.Keep(90, -1, 0));
  EXPECT_TRUE(filter.Keep(7, 1, 1));
  EXPECT_FALSE(filter.Keep(6, 1, 1));
  EXPECT_EQ(filter.dropped().outside, 3);
  EXPECT_EQ(filter.dropped().disorder, 1);
}

}  // namespace
}  // namespace evit::formats
