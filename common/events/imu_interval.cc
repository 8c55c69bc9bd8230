#include "common/events/imu_interval.h"

#include <algorithm>
#include <utility>

namespace evit {

void ImuInterval::Begin(const ImuSample& sample) {
  samples_.assign(1, sample);
  newest_ = sample;
  gap_ = 0;
}

void ImuInterval::Add(const ImuSample& sample) {
  samples_.push_back(sample);
  gap_ = std::max(gap_, sample.t - newest_.t);
  newest_ = sample;
}

ImuInterval::Closed ImuInterval::CloseAt(Utime stamp, const ImuSample& next) {
  const ImuSample boundary = stamp == next.t ? next : InterpolateImu(newest_, next, stamp);
  samples_.push_back(boundary);
  Closed closed{std::move(samples_), std::max(gap_, next.t - newest_.t)};
  samples_.assign(1, boundary);
  gap_ = 0;
  if (stamp == next.t) newest_ = next;
  return closed;
}

}  // namespace evit
