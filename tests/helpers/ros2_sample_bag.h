#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/helpers/all_events.h"
#include "tests/helpers/ros2_bags.h"
#include "tools/formats/ros/ros_recording.h"
#include "tools/formats/ros2/bag_folder.h"

/// A small recording of ROS 2, and what must be read of it whatever it is packed in.
namespace evit::formats {

using ros2::Cdr;
using ros2::Message;

constexpr Utime kStart = 1'700'000'000'000'000;

inline std::string Words(const std::vector<std::uint16_t>& words) {
  return {reinterpret_cast<const char*>(words.data()), 2 * words.size()};
}

inline std::string Packet(Utime stamp, const std::string& encoding, std::uint64_t time_base,
                          const std::string& data, bool big_endian = false) {
  return Cdr(big_endian)
      .Header(stamp)
      .Put(std::uint32_t{480})
      .Put(std::uint32_t{640})
      .Put(std::uint64_t{7})
      .Put(time_base)
      .Text(encoding)
      .Put(std::uint8_t{0})
      .Raw(data)
      .bytes();
}

// Two packets of a sensor whose clock stands at 5 s when the host's is at kStart, with IMU and truth.
inline std::vector<Message> Recording(bool big_endian = false) {
  std::vector<Message> messages;
  for (Utime k = 0; k < 2; ++k) {
    const Utime sensor = 5'000'000 + 10'000 * k;
    const auto high = static_cast<std::uint16_t>(0x8000 | (sensor >> 12 & 0xFFF));
    messages.push_back({"/cam/events",
                        Packet(kStart + 10'000 * k, "evt3", 0,
                               Words({high, static_cast<std::uint16_t>(0x6000 | (sensor & 0xFFF)), 0x0010,
                                      0x2805, 0x2006, high}),
                               big_endian),
                        kStart + 10'000 * k + 300});
    const std::vector<double> covariance(9, 0);
    messages.push_back({"/imu",
                        Cdr(big_endian)
                            .Header(kStart + 5'000 * k)
                            .Doubles({0, 0, 0, 1})
                            .Doubles(covariance)
                            .Doubles({0.1, 0.2, 0.3})
                            .Doubles(covariance)
                            .Doubles({0, 0, 9.81})
                            .Doubles(covariance)
                            .bytes(),
                        kStart + 5'000 * k});
    messages.push_back({"/odom",
                        Cdr(big_endian)
                            .Header(kStart + 4'000 * k)
                            .Text("body")
                            .Doubles({1, 2, 3, 0, 0, 0, 1})
                            .Doubles(std::vector<double>(36, 0))
                            .bytes(),
                        kStart + 4'000 * k});
  }
  return messages;
}

inline void ExpectWhole(const std::string& path) {
  RosRecording recording(OpenRos2Bag(path), {});
  EXPECT_EQ(recording.info().width, 640);
  EXPECT_EQ(recording.info().height, 480);
  const EventArray e = AllEvents(&recording, 640, 480);
  EXPECT_EQ(e.t, (std::vector<Utime>{kStart, kStart, kStart + 10'000, kStart + 10'000}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{5, 6, 5, 6}));
  EXPECT_EQ(e.y, std::vector<std::uint16_t>(4, 16));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 1, 0}));
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.imu.size(), 2U);
  EXPECT_EQ(streams.imu[1].t, kStart + 5'000);
  EXPECT_EQ(streams.imu[1].gyro, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(streams.imu[1].accel, Eigen::Vector3d(0, 0, 9.81));
  ASSERT_EQ(streams.truth.size(), 2U);
  EXPECT_EQ(streams.truth[1].t, kStart + 4'000);
  EXPECT_EQ(streams.truth[1].pose.p, Eigen::Vector3d(1, 2, 3));
}

}  // namespace evit::formats
