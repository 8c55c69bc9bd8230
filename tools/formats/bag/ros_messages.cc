#include "tools/formats/bag/ros_messages.h"

#include <cstring>
#include <stdexcept>
#include <string>

#include "common/files/load_number.h"

namespace evit::formats {
namespace {

constexpr std::size_t kEventBytes = 13;  // u16 x, u16 y, u32 s, u32 ns, u8 polarity

Utime LoadTime(const std::uint8_t* data) {
  return LoadNumber<std::uint32_t>(data) * kMicrosPerSecond +
         (Utime{LoadNumber<std::uint32_t>(data + 4)} + 500) / 1000;
}

// Walks through a message; knows where it ends.
class Cursor {
 public:
  Cursor(const std::uint8_t* data, std::size_t size) : at_(data), left_(size) {}

  const std::uint8_t* Take(std::size_t n, const char* field) {
    if (n > left_) {
      throw std::runtime_error(std::string(field) + " needs " + std::to_string(n) +
                               " bytes, the message has " + std::to_string(left_) +
                               " left; the bag is damaged or its type is another one");
    }
    const std::uint8_t* begin = at_;
    at_ += n;
    left_ -= n;
    return begin;
  }
  void Doubles(int n, double* out, const char* field) {
    std::memcpy(out, Take(sizeof(double) * n, field), sizeof(double) * n);
  }
  // std_msgs/Header: u32 seq, time stamp, string frame_id.
  Utime Header() {
    const Utime stamp = LoadTime(Take(12, "header") + 4);
    String("header.frame_id");
    return stamp;
  }
  void String(const char* field) { Take(LoadNumber<std::uint32_t>(Take(4, field)), field); }
  void End() const {
    if (left_ == 0) return;
    throw std::runtime_error(std::to_string(left_) +
                             " bytes too many; the bag is damaged or its type is another one");
  }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

}  // namespace

void DecodeEventArray(const std::uint8_t* data, std::size_t size, EventFilter* filter, EventArray* events) {
  Cursor message(data, size);
  message.Header();
  message.Take(8, "height, width");
  const std::size_t n = LoadNumber<std::uint32_t>(message.Take(4, "events"));
  const std::uint8_t* event = message.Take(n * kEventBytes, "events");
  message.End();
  for (std::size_t k = 0; k < n; ++k, event += kEventBytes) {
    const Utime t = LoadTime(event + 4);
    const auto x = LoadNumber<std::uint16_t>(event), y = LoadNumber<std::uint16_t>(event + 2);
    if (filter->Keep(x, y)) events->push_back(t, x, y, filter->Polarity(event[12]));
  }
}

ImuSample DecodeImu(const std::uint8_t* data, std::size_t size) {
  Cursor message(data, size);
  ImuSample s;
  s.t = message.Header();
  message.Take(sizeof(double) * (4 + 9), "orientation");
  message.Doubles(3, s.gyro.data(), "angular_velocity");
  message.Take(sizeof(double) * 9, "angular_velocity_covariance");
  message.Doubles(3, s.accel.data(), "linear_acceleration");
  message.Take(sizeof(double) * 9, "linear_acceleration_covariance");
  message.End();
  return s;
}

StampedPose DecodePose(const std::string& type, const std::uint8_t* data, std::size_t size) {
  const bool odometry = type == "nav_msgs/Odometry", transform = type == "geometry_msgs/TransformStamped";
  const bool covariance = odometry || type == "geometry_msgs/PoseWithCovarianceStamped";
  Cursor message(data, size);
  StampedPose s;
  s.t = message.Header();
  if (odometry || transform) message.String("child_frame_id");
  message.Doubles(3, s.pose.p.data(), transform ? "transform.translation" : "pose.position");
  message.Doubles(4, s.pose.q.coeffs().data(),  // both x y z w
                  transform ? "transform.rotation" : "pose.orientation");
  if (covariance) message.Take(sizeof(double) * 36, "pose.covariance");
  if (odometry) message.Take(sizeof(double) * (6 + 36), "twist");
  message.End();
  return s;
}

}  // namespace evit::formats
