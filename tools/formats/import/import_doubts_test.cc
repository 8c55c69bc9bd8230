#include "tools/formats/import/import_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ImportSummary Usual() {
  ImportSummary s;
  s.n_events = 3'000'000;
  s.seconds = 3;
  s.n_imu = 601;
  s.imu_rate_hz = 200;
  s.imu_covers_s = 3;
  return s;
}

TEST(ImportDoubts, NoneOfWhatIsUsual) {
  EXPECT_THAT(DoubtsOf(Usual()), IsEmpty());
  ImportSummary without = Usual();  // said elsewhere
  without.n_imu = 0;
  without.imu_rate_hz = without.imu_covers_s = 0;
  EXPECT_THAT(DoubtsOf(without), IsEmpty());
}

TEST(ImportDoubts, AHandfulOfEventsOrSamplesIsNamedWithTheLeast) {
  ImportSummary two = Usual();
  two.n_imu = 2;
  two.imu_rate_hz = 1 / 3.0;
  EXPECT_THAT(DoubtsOf(two), ElementsAre(AllOf(HasSubstr("only 2 IMU samples, 0.333 a second, for 3.0 s"),
                                               HasSubstr("needs 80 a second"))));
  ImportSummary events = Usual();
  events.n_events = 7;
  EXPECT_THAT(DoubtsOf(events), ElementsAre(AllOf(HasSubstr("only 7 events in 3.0 s"), HasSubstr("5000"))));
}

TEST(ImportDoubts, ASlowImuAndOneOfAnotherTime) {
  ImportSummary slow = Usual();
  slow.n_imu = 90;
  slow.imu_rate_hz = 30;
  EXPECT_THAT(DoubtsOf(slow), ElementsAre(HasSubstr("30 a second")));
  ImportSummary part = Usual();
  part.imu_covers_s = 0.4;
  EXPECT_THAT(DoubtsOf(part), ElementsAre(HasSubstr("cover 0.4 s of the 3.0 s")));
}

}  // namespace
}  // namespace evit::formats
