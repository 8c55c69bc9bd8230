#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/imu/imu_sample.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "common/time/ahead_guard.h"
#include "services/window_optimizer/imu_history.h"

namespace evit {

/// IMU as this service hears it, with the last seconds kept. A sender that was restarted clears them; broken
/// messages are counted as IMU.invalid, samples far ahead of those that follow as IMU.ahead.
class ImuInbox {
 public:
  explicit ImuInbox(StatusReporter* status)
      : counter_(status, "IMU"), ahead_(&status->Counter("IMU.ahead")) {}

  /// A message of the channel. Returns its samples, but for those not newer than what is there already.
  std::vector<ImuSample> OnMessage(const std::uint8_t* data, std::size_t size);

  const ImuHistory& history() const { return history_; }

 private:
  SequenceCounter counter_;
  std::int64_t* ahead_;
  AheadGuard<ImuSample> guard_;
  ImuHistory history_;
};

}  // namespace evit
