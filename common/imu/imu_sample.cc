#include "common/imu/imu_sample.h"

namespace evit {

ImuSample InterpolateImu(const ImuSample& a, const ImuSample& b, Utime t) {
  const double s = static_cast<double>(t - a.t) / static_cast<double>(b.t - a.t);
  return {t, a.gyro + s * (b.gyro - a.gyro), a.accel + s * (b.accel - a.accel)};
}

}  // namespace evit
