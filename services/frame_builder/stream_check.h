#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// Notices from live streams what no tracker can do anything with: an IMU in other units, two clocks, and no
/// IMU where one is needed.
class StreamCheck {
 public:
  explicit StreamCheck(bool needs_imu) : needs_imu_(needs_imu) {}

  void AddImu(const ImuSample& sample);
  /// The stamp up to which events are known.
  void AddEvents(Utime newest);
  void Clear();

  /// A sentence for a person; empty where all is well, or too little has come to tell.
  std::string Complaint() const;

 private:
  static constexpr Utime kLook = 3 * kMicrosPerSecond;  // of IMU samples

  bool needs_imu_;
  std::vector<ImuSample> first_;  // until they have been looked at
  bool looked_ = false;
  std::string units_;
  Utime event_ = 0, imu_ = 0;  // newest stamps, when both streams last moved
  Utime newest_imu_ = 0;
  std::optional<Utime> waits_since_;  // of events, while no IMU sample has come
  bool has_imu_ = false, waits_in_vain_ = false;
  std::int64_t apart_ = 0;  // how often in a row they were of two clocks
  bool imu_moved_ = false;  // since the last packet: where one stream stands still, stamps drift apart
};

}  // namespace evit
