#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"
#include "common/wire/event_wire.h"

namespace evit {

/// What an import wrote, for tests to compare with what it was made of.
struct ImportedLog {
  EventArray events;
  std::vector<ImuSample> imu;
  Trajectory truth;
};

inline ImportedLog ReadImported(const std::string& path) {
  ImportedLog out;
  const LogReader log(path);
  std::vector<std::uint8_t> bytes;
  std::string why;
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  for (const LogEntry& entry : log.entries()) {
    EXPECT_GE(entry.utime, last);
    last = entry.utime;
    log.Read(entry, &bytes);
    if (log.channel(entry) == "EVENTS") {
      event_packet_t m;
      EXPECT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &m, &why)) << why;
      AppendEvents(m, &out.events);
    } else if (log.channel(entry) == "IMU") {
      imu_batch_t m;
      EXPECT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &m, &why)) << why;
      out.imu.push_back({m.utime, Eigen::Vector3d(m.gyro[0].data()), Eigen::Vector3d(m.accel[0].data())});
    } else {
      body_pose_t m;
      EXPECT_EQ(log.channel(entry), "GROUND_TRUTH");
      EXPECT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &m, &why)) << why;
      out.truth.push_back({m.utime, {Eigen::Quaterniond(m.orientation), Eigen::Vector3d(m.position)}});
    }
  }
  return out;
}

inline void ExpectSame(const EventArray& a, const EventArray& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.p, b.p);
}

inline void ExpectSame(const std::vector<ImuSample>& a, const std::vector<ImuSample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].t, b[k].t) << k;
    ASSERT_EQ(a[k].gyro, b[k].gyro) << k;
    ASSERT_EQ(a[k].accel, b[k].accel) << k;
  }
}

inline void ExpectSame(const Trajectory& a, const Trajectory& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].t, b[k].t) << k;
    ASSERT_EQ(a[k].pose.p, b[k].pose.p) << k;
    ASSERT_EQ(a[k].pose.q.coeffs(), b[k].pose.q.coeffs()) << k;
  }
}

}  // namespace evit
