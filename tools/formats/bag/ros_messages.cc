#include "tools/formats/bag/ros_messages.h"

#include <stdexcept>
#include <string>

#include "common/files/load_number.h"
#include "tools/formats/ros/message_types.h"
#include "tools/formats/ros/ros_cursor.h"

namespace evit::formats {
namespace {

constexpr std::size_t kEventBytes = 13;  // u16 x, u16 y, u32 s, u32 ns, u8 polarity

Utime LoadTime(const std::uint8_t* data) {
  return LoadNumber<std::uint32_t>(data) * kMicrosPerSecond +
         (Utime{LoadNumber<std::uint32_t>(data + 4)} + 500) / 1000;
}

void RequireEnd(const RosCursor& message) {
  if (message.left() == 0) return;
  throw std::runtime_error(std::to_string(message.left()) +
                           " bytes too many; the bag is damaged or its type is another one");
}

}  // namespace

void DecodeEventArray(const std::uint8_t* data, std::size_t size, EventFilter* filter, EventArray* events) {
  RosCursor message(data, size, false);
  message.Header();
  message.Take(8, "height, width");
  const std::size_t n = message.Get<std::uint32_t>("events");
  const std::uint8_t* event = message.Take(n * kEventBytes, "events");
  RequireEnd(message);
  for (std::size_t k = 0; k < n; ++k, event += kEventBytes) {
    const Utime t = LoadTime(event + 4);
    const auto x = LoadNumber<std::uint16_t>(event), y = LoadNumber<std::uint16_t>(event + 2);
    if (filter->Keep(x, y)) events->push_back(t, x, y, filter->Polarity(event[12]));
  }
}

ImuSample DecodeImu(const std::uint8_t* data, std::size_t size) {
  RosCursor message(data, size, false);
  ImuSample sample = GetImu(&message);
  RequireEnd(message);
  return sample;
}

StampedPose DecodePose(const std::string& type, const std::uint8_t* data, std::size_t size) {
  RosCursor message(data, size, false);
  StampedPose pose = GetPose(type, &message);
  const bool odometry = type == "nav_msgs/Odometry";
  if (odometry || type == "geometry_msgs/PoseWithCovarianceStamped")
    message.SkipDoubles(36, "pose.covariance");
  if (odometry) message.SkipDoubles(6 + 36, "twist");
  RequireEnd(message);
  return pose;
}

}  // namespace evit::formats
