#include "tools/mapping/build_report.h"

#include <gmock/gmock.h>

namespace evit::mapping {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

BuiltMap Built(std::size_t measured, std::size_t alone, std::size_t confirmed) {
  BuiltMap built;
  built.points.resize(1000);
  built.measured = measured, built.alone = alone, built.confirmed = confirmed;
  return built;
}

TEST(DoubtOf, NamesDepthsThatDisagree) {
  EXPECT_EQ(DoubtOf(Built(1000, 300, 600)), "");
  EXPECT_THAT(DoubtOf(Built(1000, 300, 500)), HasSubstr("only 71 % of the depths agree"));
  EXPECT_THAT(DoubtOf(Built(1000, 300, 200)), HasSubstr("only 29 % of the depths agree"));
}

TEST(DoubtOf, ViewsWithoutOverlapDoNotDisagree) {
  for (const BuiltMap& built : {Built(1000, 1000, 0), Built(1000, 990, 0)}) {
    EXPECT_THAT(DoubtOf(built), HasSubstr("hardly any place is in the sight of two views"));
    EXPECT_THAT(DoubtOf(built), Not(HasSubstr("agree between")));
  }
}

TEST(SummaryOf, SaysWhatOtherViewsConfirm) {
  EXPECT_THAT(SummaryOf("room.pcd", Built(1000, 200, 600)), HasSubstr("75 % confirmed by other views"));
  EXPECT_THAT(SummaryOf("room.pcd", Built(1000, 1000, 0)), HasSubstr("none in the sight of a second view"));
}

}  // namespace
}  // namespace evit::mapping
