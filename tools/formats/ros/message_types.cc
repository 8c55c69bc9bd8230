#include "tools/formats/ros/message_types.h"

#include <stdexcept>

namespace evit::formats {

SensorSizeInMessage GetEventArray(RosCursor message, EventArray* events) {
  message.Header();
  SensorSizeInMessage size;
  size.height = message.Get<std::uint32_t>("height");
  size.width = message.Get<std::uint32_t>("width");
  const auto n = message.Get<std::uint32_t>("events");
  constexpr std::size_t kLeast = 13;  // bytes an event
  if (n > 0 && n > message.left() / kLeast + 1)
    throw std::runtime_error("events: " + std::to_string(n) +
                             " do not fit into the message; the bag is damaged");
  for (std::uint32_t k = 0; k < n; ++k) {
    const auto x = message.Get<std::uint16_t>("events.x");
    const auto y = message.Get<std::uint16_t>("events.y");
    const Utime t = message.Time("events.ts");
    events->push_back(t, x, y, message.Get<std::uint8_t>("events.polarity") != 0 ? 1 : 0);
  }
  return size;
}

EventPacket GetEventPacket(RosCursor message) {
  EventPacket packet;
  packet.stamp = message.Header();
  packet.height = message.Get<std::uint32_t>("height");
  packet.width = message.Get<std::uint32_t>("width");
  message.Get<std::uint64_t>("seq");
  packet.time_base = message.Get<std::uint64_t>("time_base");
  packet.encoding = message.Text("encoding");
  if (message.Get<std::uint8_t>("is_bigendian") != 0)
    throw std::runtime_error("is_bigendian is set: only packets of little-endian machines can be read");
  packet.size = message.Get<std::uint32_t>("events");
  packet.data = message.Take(packet.size, "events");
  return packet;
}

ImuSample GetImu(RosCursor* message) {
  ImuSample s;
  s.t = message->Header();
  message->SkipDoubles(4 + 9, "orientation");
  message->Doubles(3, s.gyro.data(), "angular_velocity");
  message->SkipDoubles(9, "angular_velocity_covariance");
  message->Doubles(3, s.accel.data(), "linear_acceleration");
  message->SkipDoubles(9, "linear_acceleration_covariance");
  return s;
}

StampedPose GetPose(const std::string& type, RosCursor* message) {
  const bool odometry = type == "nav_msgs/Odometry", transform = type == "geometry_msgs/TransformStamped";
  StampedPose s;
  s.t = message->Header();
  if (odometry || transform) message->Text("child_frame_id");
  message->Doubles(3, s.pose.p.data(), transform ? "transform.translation" : "pose.position");
  message->Doubles(4, s.pose.q.coeffs().data(),  // both x y z w
                   transform ? "transform.rotation" : "pose.orientation");
  return s;
}

}  // namespace evit::formats
