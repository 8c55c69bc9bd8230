#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// Notices from live streams what no tracker can do anything with: an IMU in other units, and two clocks.
class StreamCheck {
 public:
  void AddImu(const ImuSample& sample);
  /// The stamp up to which events are known.
  void AddEvents(Utime newest);
  void Clear() { *this = {}; }

  /// A sentence for a person; empty where all is well, or too little has come to tell.
  std::string Complaint() const;

 private:
  static constexpr Utime kLook = 3 * kMicrosPerSecond;  // of IMU samples

  std::vector<ImuSample> first_;  // until they have been looked at
  bool looked_ = false;
  std::string units_;
  Utime event_ = 0, imu_ = 0;  // newest stamps, when both streams last moved
  Utime newest_imu_ = 0;
  std::int64_t apart_ = 0;  // how often in a row they were of two clocks
  bool imu_moved_ = false;  // since the last packet: where one stream stands still, stamps drift apart
};

}  // namespace evit
