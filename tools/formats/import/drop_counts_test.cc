#include "tools/formats/import/drop_counts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tools/formats/import/event_filter.h"

namespace evit::formats {
namespace {

TEST(DropCounts, TextListsReasonsAndIsEmptyWithoutDrops) {
  EXPECT_EQ(DropText({}, "events"), "");
  EXPECT_EQ(
      DropText({3, 2}, "events"),
      "5 events dropped: 3 not later than the one before, or by more than 50 ms late, 2 with a time far "
      "ahead of those that follow");
  EXPECT_EQ(
      DropText({0, 0, 1, 9}, "events"),
      "10 events dropped: 1 not a number, or no rotation, 9 outside the sensor (is the image size right?)");
  EXPECT_EQ(DropText({0, 0, 0, 0, 0, 8}, "events"), "8 events put into order of time");
}

TEST(DropCounts, MoreThanATwentiethIsTooMuch) {
  EXPECT_NO_THROW(RequireMostKept("a.bag", {50}, 950, "events"));
  EXPECT_NO_THROW(RequireMostKept("a.bag", {2}, 10, "events"));  // a handful says nothing
  EXPECT_THAT([] { RequireMostKept("a.bag", {51}, 949, "events"); },
              ::testing::ThrowsMessage<std::runtime_error>(::testing::AllOf(
                  ::testing::HasSubstr("a.bag: 51 events dropped"), ::testing::HasSubstr("of 1000"),
                  ::testing::HasSubstr("sort the recording"))));
  EXPECT_THROW(RequireMostKept("a.bag", {0, 0, 0, 60}, 940, "events"), std::runtime_error);
}

TEST(DropCounts, AFilterKeepsWhatIsOnTheSensor) {
  EventFilter filter(4, 3);
  EXPECT_TRUE(filter.Keep(0, 0));
  EXPECT_TRUE(filter.Keep(3, 2));
  EXPECT_FALSE(filter.Keep(4, 0));
  EXPECT_FALSE(filter.Keep(0, 3));
  EXPECT_FALSE(filter.Keep(-1, 0));
  EXPECT_EQ(filter.dropped().outside, 3);
}

TEST(DropCounts, PixelsThatCountFromOneAreRefusedHoweverFewAreOutside) {
  for (const int first : {0, 1}) {
    EventFilter filter(40, 30);
    for (int k = 0; k < 2000; ++k) filter.Keep(first + k % 40, first + k % 30);
    EventArray one_more;
    one_more.push_back(0, 40, 3, 1);
    filter.Apply(&one_more);
    const auto check = [&] { RequireMostKept("a.txt", filter.dropped(), 1900, "events"); };
    if (first == 0) {
      EXPECT_NO_THROW(check());
    } else {
      EXPECT_THAT(check,
                  ::testing::ThrowsMessage<std::runtime_error>(::testing::HasSubstr("counted from 1")));
    }
  }
}

}  // namespace
}  // namespace evit::formats
