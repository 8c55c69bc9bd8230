#include "services/frame_builder/stream_check.h"

#include <cstdlib>

#include "common/imu/imu_plausibility.h"
#include "common/text/format_text.h"

namespace evit {
namespace {

constexpr std::int64_t kEnough = 50;               // of both streams, before their clocks are compared
constexpr Utime kOneClock = 5 * kMicrosPerSecond;  // more apart: no delay explains it

}  // namespace

void StreamCheck::AddImu(const ImuSample& sample) {
  ++n_imu_;
  newest_imu_ = sample.t;
  imu_moved_ = true;
  if (looked_) return;
  first_.push_back(sample);
  if (sample.t - first_.front().t < kLook) return;
  looked_ = true;
  units_ = ImuComplaint(first_);
  first_ = {};
}

void StreamCheck::AddEvents(Utime newest) {
  ++n_events_;
  if (!imu_moved_) return;
  imu_moved_ = false;
  event_ = newest;
  imu_ = newest_imu_;
}

std::string StreamCheck::Complaint() const {
  if (n_events_ >= kEnough && n_imu_ >= kEnough && std::llabs(event_ - imu_) > kOneClock) {
    return FormatText(
        "EVENTS are stamped %.3f s and IMU %.3f s: two clocks; have both stamped by one, the sensor's or the "
        "host's",
        ToSeconds(event_), ToSeconds(imu_));
  }
  return units_;
}

}  // namespace evit
