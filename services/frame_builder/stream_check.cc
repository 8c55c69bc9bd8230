#include "services/frame_builder/stream_check.h"

#include <cstdlib>

#include "common/imu/imu_plausibility.h"
#include "common/text/format_text.h"

namespace evit {
namespace {

constexpr std::int64_t kEnough = 50;  // comparisons in a row, before a second clock is believed in
constexpr Utime kOneClock = 5 * kMicrosPerSecond;  // more apart: no delay explains it

}  // namespace

void StreamCheck::Clear() { *this = StreamCheck(needs_imu_); }

void StreamCheck::AddImu(const ImuSample& sample) {
  has_imu_ = true;
  waits_in_vain_ = false;
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
  if (needs_imu_ && !has_imu_) {
    if (!waits_since_) waits_since_ = newest;
    waits_in_vain_ = newest - *waits_since_ > kLook;
  }
  if (!imu_moved_) return;
  imu_moved_ = false;
  event_ = newest;
  imu_ = newest_imu_;
  apart_ = std::llabs(event_ - imu_) > kOneClock ? apart_ + 1 : 0;
}

std::string StreamCheck::Complaint() const {
  if (apart_ >= kEnough) {
    return FormatText(
        "EVENTS are stamped %.3f s and IMU %.3f s: two clocks; have both stamped by one, the sensor's or the "
        "host's",
        ToSeconds(event_), ToSeconds(imu_));
  }
  if (waits_in_vain_)
    return "EVENTS come, but no IMU: send IMU too, or track by events alone with config/evt.textproto";
  return units_;
}

}  // namespace evit
