#include "common/localization/search_schedule.h"

#include <algorithm>

namespace evit {
namespace {

constexpr double kAtOnce = 5;        // searches one after the other, of one keyframe
constexpr double kPerS = 10;         // searches in the long run: what two slow cores can do
constexpr Utime kApart = 2'000'000;  // us: what was tried longer ago says nothing

}  // namespace

void SearchSchedule::Clear() {
  verticals_.Clear();
  tried_at_ = last_ = 0;
}

double SearchSchedule::Allowed(Utime t) const {
  return last_ == 0 || t < last_ ? kAtOnce : std::min(kAtOnce, allowed_ + kPerS * ToSeconds(t - last_));
}

bool SearchSchedule::Due(Utime t, bool convinced) const {
  if (convinced && last_ != 0) return ToSeconds(t - last_) >= again_s_;
  return Allowed(t) >= 1 - 1e-6;
}

Eigen::Vector3d SearchSchedule::Begin(Utime t, const Upright& upright, const RecentImu& imu) {
  if (t < tried_at_ || t - tried_at_ > kApart) verticals_.Clear();
  Eigen::Vector3d up = verticals_.Next(upright, imu.Turn(tried_at_, t), ToSeconds(t - tried_at_));
  tried_at_ = t;
  BeginComparison(t);
  return up;
}

void SearchSchedule::BeginComparison(Utime t) {
  allowed_ = std::max(0.0, Allowed(t) - 1);
  last_ = t;
}

}  // namespace evit
