#include "common/geometry/pose_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace evit {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ParsePose, TakesPositionThenQuaternionWithTheScalarLast) {
  const SE3 pose = ParsePose("--initial-pose", "  1 -2.5 3e-1  0 0 0.6 0.8 ");
  EXPECT_EQ(pose.p, Eigen::Vector3d(1, -2.5, 0.3));
  EXPECT_NEAR(pose.q.z(), 0.6, 1e-15);
  EXPECT_NEAR(pose.q.w(), 0.8, 1e-15);
}

TEST(ParsePose, NormalisesARoundedQuaternion) {
  const SE3 pose = ParsePose("--initial-pose", "0 0 0 0.707 0 0 0.707");
  EXPECT_NEAR(pose.q.norm(), 1, 1e-15);
}

TEST(ParsePose, NamesTheOptionTheTextAndWhatWasExpected) {
  for (const char* text :
       {"", "1 2 3", "0 0 0 0 0 0 1 x", "0 0 0 0 0 0 one", "nan 0 0 0 0 0 1", "0 0 0 0 0 0 nan"}) {
    EXPECT_THAT([&] { ParsePose("--pose", text); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr(std::string("--pose \"") + text + "\""), HasSubstr("x y z (m)"))))
        << text;
  }
}

TEST(ParsePose, SaysHowLongAQuaternionIsThatIsNoRotation) {
  EXPECT_THAT([] { ParsePose("--pose", "0 0 0 0 0 0 2"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("norm is 2.0")));
}

}  // namespace
}  // namespace evit
