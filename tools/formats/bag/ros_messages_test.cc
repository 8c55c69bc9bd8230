#include "tools/formats/bag/ros_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/ros_bags.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::uint8_t* Data(const std::string& bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

TEST(RosMessages, NanosecondsAreRoundedToMicroseconds) {
  std::string bytes =
      ImuMessage({1'642'661'138'836'530, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}).bytes;
  const std::uint32_t nanoseconds = 836'530'500;
  std::memcpy(&bytes[8], &nanoseconds, 4);
  EXPECT_EQ(DecodeImu(Data(bytes), bytes.size()).t, 1'642'661'138'836'531);
}

TEST(RosMessages, TruncatedAndOverlongMessagesAreRejected) {
  EventArray events;
  for (int k = 0; k < 3; ++k) events.push_back(k, 1, 2, 1);
  const std::string array = EventsMessage(kEventTypes[0], events, 0, 3).bytes, imu = ImuMessage({}).bytes,
                    pose = PoseMessage({}).bytes;
  EventFilter filter(240, 180);
  EventArray out;
  for (std::size_t n = 0; n <= array.size() + 1; ++n) {
    const std::string cut = (array + "x").substr(0, n);  // of exactly n bytes, so that a sanitizer sees more
    if (n == array.size()) continue;
    EXPECT_THROW(DecodeEventArray(Data(cut), n, &filter, &out), std::runtime_error) << n;
  }
  EXPECT_EQ(out.size(), 0U);
  for (std::size_t n = 0; n <= imu.size() + 1; ++n) {
    const std::string cut = (imu + "x").substr(0, n);
    if (n == imu.size()) continue;
    EXPECT_THROW(DecodeImu(Data(cut), n), std::runtime_error) << n;
  }
  for (std::size_t n = 0; n <= pose.size() + 1; ++n) {
    const std::string cut = (pose + "x").substr(0, n);
    if (n == pose.size()) continue;
    EXPECT_THROW(DecodePose(kTruthTypes[0], Data(cut), n), std::runtime_error) << n;
  }
}

TEST(RosMessages, ForgedCountDoesNotReserveMemory) {
  EventArray events;
  events.push_back(1, 1, 1, 1);
  std::string bytes = EventsMessage(kEventTypes[0], events, 0, 1).bytes;
  const std::uint32_t count = 0xffffffff;
  std::memcpy(&bytes[bytes.size() - 13 - 4], &count, 4);
  EventFilter filter(240, 180);
  EventArray out;
  EXPECT_THAT([&] { DecodeEventArray(Data(bytes), bytes.size(), &filter, &out); },
              ThrowsMessage<std::runtime_error>(HasSubstr("events needs 55834574835 bytes")));
}

}  // namespace
}  // namespace evit::formats
