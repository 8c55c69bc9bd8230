#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tests/helpers/doctor_faults.h"

namespace evit::doctor {
namespace {

// Whether it often turns faster about an axis, in rad/s: a smaller range would hardly show.
bool TurnsFaster(const Sample& s, double rate) {
  const auto n = std::count_if(s.imu.begin(), s.imu.end(),
                               [rate](const ImuSample& i) { return i.gyro.cwiseAbs().maxCoeff() > rate; });
  return 50 * n > static_cast<std::ptrdiff_t>(s.imu.size());
}

}  // namespace

std::vector<Fault> ImuFaults() {
  return {
      {"AccelerometerInG", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel /= 9.81;
       }},
      {"AccelerometerInMillimetres", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 1000;
       }},
      {"GravityRemoved", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) {
           SE3 pose;
           if (PoseAt(s->truth, i.t, &pose)) i.accel -= pose.q.conjugate() * Eigen::Vector3d(0, 0, 9.81);
         }
       }},
      {"GyroInDegrees", "imu-gyro-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro *= 57.29578;
       }},
      {"GyroTurned", "imu-gyro-axes",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro = -i.gyro;
       }},
      {"GyroCutOff", "imu-saturation",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro = (5 * i.gyro).cwiseMax(-1.2).cwiseMin(1.2);
       },
       [](const Sample& s) { return TurnsFaster(s, 1.2 / 5); }},
      {"ImuSamplesMissing", "imu-gaps",
       [](Sample* s) {
         std::vector<ImuSample> kept;
         for (const ImuSample& i : s->imu)
           if (std::abs(i.t - s->imu.front().t - 1'500'000) > 150'000) kept.push_back(i);
         s->imu = kept;
       }},
      {"ImuTooSlow", "imu-rate",
       [](Sample* s) {
         std::vector<ImuSample> kept;
         for (std::size_t k = 0; k < s->imu.size(); k += 8) kept.push_back(s->imu[k]);
         s->imu = kept;
       }},
      {"GyroZero", "imu-gyro-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro.setZero();
       }},
      {"ImuStampsRepeat", "imu-order",
       [](Sample* s) {
         for (std::size_t k = 3; k < s->imu.size(); k += 3) s->imu[k].t = s->imu[k - 1].t;
       }},
      {"ImuVibrates", "imu-noise",
       [](Sample* s) {
         std::mt19937 random(3);
         std::normal_distribution<double> noise(0, 0.4);
         for (ImuSample& i : s->imu)
           for (int axis = 0; axis < 3; ++axis)
             i.gyro[axis] += noise(random), i.accel[axis] += 2 * noise(random);
       }},
      {"AccelerometerInCentimetres", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 100;
       }},
      {"AccelerometerReadsTenPercentMore", "imu-accel-scale",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 1.1;
       }},
      {"AccelerometerReadsFifteenPercentLess", "imu-accel-scale",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 0.85;
       }},
      {"GyroRangeTooSmall", "imu-saturation",
       [](Sample* s) {
         for (ImuSample& i : s->imu)
           for (int axis = 0; axis < 3; ++axis) i.gyro[axis] = std::clamp(6 * i.gyro[axis], -1.5, 1.5);
       },
       [](const Sample& s) { return TurnsFaster(s, 1.5 / 6); }},
  };
}

}  // namespace evit::doctor
