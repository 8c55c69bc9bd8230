#pragma once

#include <rosbag/bag.h>

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"

/// Messages as ROS puts them into a bag, for tests: bytes with a type's name.
namespace evit {

struct RawMessage {
  std::string type;
  std::string bytes;
};

class RosBytes {
 public:
  template <typename T>
  RosBytes& Put(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  RosBytes& Time(Utime t) {
    return Put(static_cast<std::uint32_t>(t / kMicrosPerSecond))
        .Put(static_cast<std::uint32_t>(t % kMicrosPerSecond * 1000));
  }
  RosBytes& Doubles(const std::vector<double>& values) {
    for (const double v : values) Put(v);
    return *this;
  }
  RosBytes& Header(Utime t) { return Put(std::uint32_t{7}).Time(t).String("body"); }
  RosBytes& String(const std::string& text) {
    Put(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

inline RawMessage EventsMessage(const std::string& type, const EventArray& e, std::size_t begin,
                                std::size_t end) {
  RosBytes out;
  out.Header(e.t[begin]).Put(std::uint32_t{180}).Put(std::uint32_t{240});
  out.Put(static_cast<std::uint32_t>(end - begin));
  for (std::size_t k = begin; k < end; ++k) out.Put(e.x[k]).Put(e.y[k]).Time(e.t[k]).Put(e.p[k]);
  return {type, out.bytes()};
}

inline RawMessage ImuMessage(const ImuSample& s) {
  const std::vector<double> covariance(9, -1);
  RosBytes out;
  out.Header(s.t).Doubles({0, 0, 0, 1}).Doubles(covariance);
  out.Doubles({s.gyro.x(), s.gyro.y(), s.gyro.z()}).Doubles(covariance);
  out.Doubles({s.accel.x(), s.accel.y(), s.accel.z()}).Doubles(covariance);
  return {"sensor_msgs/Imu", out.bytes()};
}

inline RawMessage PoseMessage(const StampedPose& s) {
  RosBytes out;
  out.Header(s.t).Doubles({s.pose.p.x(), s.pose.p.y(), s.pose.p.z()});
  out.Doubles({s.pose.q.x(), s.pose.q.y(), s.pose.q.z(), s.pose.q.w()});
  return {"geometry_msgs/PoseStamped", out.bytes()};
}

/// sensor_msgs/Image in rows without a rest.
inline RawMessage ImageMessage(Utime t, std::uint32_t width, std::uint32_t height,
                               const std::string& encoding, const std::string& data) {
  RosBytes out;
  out.Header(t).Put(height).Put(width).String(encoding).Put(std::uint8_t{0});
  out.Put(static_cast<std::uint32_t>(data.size() / height)).String(data);
  return {"sensor_msgs/Image", out.bytes()};
}

inline RawMessage CompressedImageMessage(Utime t, const std::string& format, const std::string& data) {
  RosBytes out;
  out.Header(t).String(format).String(data);
  return {"sensor_msgs/CompressedImage", out.bytes()};
}

/// The pose as one of the other types that tell of it.
inline RawMessage TruthMessage(const std::string& type, const StampedPose& s) {
  const bool odometry = type == "nav_msgs/Odometry";
  RosBytes out;
  out.Header(s.t);
  if (odometry || type == "geometry_msgs/TransformStamped") out.String("base_link");
  out.Doubles({s.pose.p.x(), s.pose.p.y(), s.pose.p.z()});
  out.Doubles({s.pose.q.x(), s.pose.q.y(), s.pose.q.z(), s.pose.q.w()});
  if (odometry || type == "geometry_msgs/PoseWithCovarianceStamped")
    out.Doubles(std::vector<double>(36, 0.5));
  if (odometry) out.Doubles(std::vector<double>(6 + 36, 0.25));
  return {type, out.bytes()};
}

/// Recorded `delay` us after `t`.
inline void Record(rosbag::Bag* bag, const std::string& topic, Utime t, const RawMessage& message,
                   Utime delay = 100) {
  const auto at = static_cast<std::uint64_t>(t + delay);
  bag->write(topic, ros::Time(static_cast<std::uint32_t>(at / 1'000'000), at % 1'000'000 * 1000), message);
}

}  // namespace evit

namespace ros {
namespace message_traits {
template <>
struct MD5Sum<evit::RawMessage> {
  static const char* value(const evit::RawMessage&) { return "0123456789abcdef0123456789abcdef"; }
};
template <>
struct DataType<evit::RawMessage> {
  static const char* value(const evit::RawMessage& m) { return m.type.c_str(); }
};
template <>
struct Definition<evit::RawMessage> {
  static const char* value(const evit::RawMessage&) { return "# not needed"; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<evit::RawMessage> {
  template <typename Stream>
  static void write(Stream& stream, const evit::RawMessage& m) {
    std::memcpy(stream.advance(static_cast<std::uint32_t>(m.bytes.size())), m.bytes.data(), m.bytes.size());
  }
  static std::uint32_t serializedLength(const evit::RawMessage& m) {
    return static_cast<std::uint32_t>(m.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros
