// Faults of the IMU: units, axes, gravity, range, noise, biases, rate, stamps and clocks.
#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/so3.h"
#include "common/text/format_text.h"
#include "tests/helpers/random_faults.h"

namespace evit::doctor {
namespace {

std::string AccelUnit(Sample* s, Chance* chance) {
  const std::array<std::pair<const char*, double>, 4> units{
      {{"g", 1 / 9.80665}, {"mg", 1e3 / 9.80665}, {"cm/s^2", 100}, {"feet/s^2", 3.28084}}};
  const auto& [name, factor] = units[static_cast<std::size_t>(Pick(chance, 4))];
  for (ImuSample& i : s->imu) i.accel *= factor;
  return FormatText("accelerometer in %s", name);
}

std::string GyroUnit(Sample* s, Chance* chance) {
  const int what = Pick(chance, 3);
  for (ImuSample& i : s->imu) {
    i.gyro *= what == 2 ? M_PI / 180 : 180 / M_PI;
    if (what == 1) i.accel /= 9.80665;
  }
  return what == 0   ? "gyro in deg/s"
         : what == 1 ? "gyro in deg/s and accelerometer in g"
                     : "gyro converted from degrees twice";
}

std::string RemoveGravity(Sample* s, Chance* chance) {
  const bool in_g = Pick(chance, 3) == 0;
  for (ImuSample& i : s->imu) {
    SE3 pose;
    if (PoseAt(s->truth, i.t, &pose)) i.accel -= pose.q.conjugate() * Eigen::Vector3d(0, 0, s->rig.gravity);
    if (in_g) i.accel /= 9.80665;
  }
  return in_g ? "linear acceleration, in g" : "linear acceleration";
}

// Of gyro or accelerometer alone, or of both alike, as of a body frame that the rig file does not know.
std::string SwapAxes(Sample* s, Chance* chance) {
  const int of = Pick(chance, 3), a = Pick(chance, 3), b = (a + 1) % 3;
  for (ImuSample& i : s->imu) {
    if (of != 1) std::swap(i.gyro[a], i.gyro[b]);
    if (of != 0) std::swap(i.accel[a], i.accel[b]);
    if (of == 2) i.gyro[a] = -i.gyro[a], i.accel[a] = -i.accel[a];
  }
  return FormatText("axes %c and %c of %s swapped", 'x' + a, 'x' + b,
                    of == 0   ? "the gyro"
                    : of == 1 ? "the accelerometer"
                              : "both");
}

std::string MirrorAxis(Sample* s, Chance* chance) {
  const bool gyro = Pick(chance, 2) == 0;
  const int axis = Pick(chance, 3);
  for (ImuSample& i : s->imu) (gyro ? i.gyro : i.accel)[axis] *= -1;
  return FormatText("axis %c of the %s mirrored", 'x' + axis, gyro ? "gyro" : "accelerometer");
}

// A range of which the motion uses more.
std::string Saturate(Sample* s, Chance* chance) {
  const bool gyro = Pick(chance, 2) == 0;
  const double part = Draw(chance, 0.4, 0.8);
  double most = 0;
  for (const ImuSample& i : s->imu)
    most = std::max(most, (gyro ? i.gyro : i.accel).lpNorm<Eigen::Infinity>());
  const double range = gyro ? part * most : s->rig.gravity + part * (most - s->rig.gravity);
  if (most < (gyro ? 0.5 : 12)) return "";
  for (ImuSample& i : s->imu) {
    Eigen::Vector3d& v = gyro ? i.gyro : i.accel;
    v = v.cwiseMax(-range).cwiseMin(range);
  }
  return FormatText("%s cut off at %.2f, of %.2f", gyro ? "gyro" : "accelerometer", range, most);
}

std::string ShakeImu(Sample* s, Chance* chance) {
  const double times = Draw(chance, 10, 40);
  const double root = std::sqrt(s->rig.imu_rate_hz);
  std::normal_distribution<double> noise;
  for (ImuSample& i : s->imu) {
    for (int axis = 0; axis < 3; ++axis) {
      i.gyro[axis] += times * s->rig.imu_noise.gyro_density * root * noise(*chance);
      i.accel[axis] += times * s->rig.imu_noise.accel_density * root * noise(*chance);
    }
  }
  return FormatText("noise of %.0f times the rig file's", times);
}

std::string BiasGyro(Sample* s, Chance* chance) {
  const Eigen::Vector3d bias = Draw(chance, 0.2, 0.8) * DrawDirection(chance);
  for (ImuSample& i : s->imu) i.gyro += bias;
  return FormatText("a gyro bias of %.2f rad/s", bias.norm());
}

std::string ScaleAccel(Sample* s, Chance* chance) {
  const double off = Either(chance, -1, 1) * Draw(chance, 0.08, 0.18);
  for (ImuSample& i : s->imu) i.accel *= 1 + off;
  return FormatText("the accelerometer reads %+.0f %%", 100 * off);
}

std::string SlowImu(Sample* s, Chance* chance) {
  const int n = 2 + Pick(chance, 20);
  std::vector<ImuSample> kept;
  for (std::size_t k = 0; k < s->imu.size(); k += static_cast<std::size_t>(n)) kept.push_back(s->imu[k]);
  s->imu = std::move(kept);
  return FormatText("one of %d IMU samples", n);
}

std::string LoseImu(Sample* s, Chance* chance) {
  const bool burst = Pick(chance, 2) == 0;
  const double share = burst ? Draw(chance, 0.05, 0.2) : Draw(chance, 0.25, 0.5);
  const Utime first = s->imu.front().t, whole = s->imu.back().t - first;
  const double from = Draw(chance, 0.1, 0.7);
  std::vector<ImuSample> kept;
  for (const ImuSample& i : s->imu) {
    const double at = static_cast<double>(i.t - first) / static_cast<double>(whole);
    if (burst ? at < from || at > from + share : Draw(chance, 0, 1) > share) kept.push_back(i);
  }
  s->imu = std::move(kept);
  return FormatText("%.0f %% of the IMU samples lost %s", 100 * share, burst ? "at once" : "here and there");
}

std::string SpoilImuOrder(Sample* s, Chance* chance) {
  const bool repeat = Pick(chance, 2) == 0;
  const double share = Draw(chance, 0.02, 0.4);
  for (std::size_t k = 1; k < s->imu.size(); ++k) {
    if (Draw(chance, 0, 1) > share) continue;
    repeat ? void(s->imu[k].t = s->imu[k - 1].t) : std::swap(s->imu[k].t, s->imu[k - 1].t);
  }
  return FormatText("%.0f %% of the IMU's stamps %s", 100 * share, repeat ? "repeat" : "swapped");
}

std::string ScaleImuStamps(Sample* s, Chance* chance) {
  const bool longer = Pick(chance, 2) == 0;
  const Utime first = s->imu.front().t;
  for (ImuSample& i : s->imu) i.t = first + (longer ? 1000 * (i.t - first) : (i.t - first) / 1000);
  return longer ? "stamps of the IMU in ns" : "stamps of the IMU in ms";
}

std::string OtherEpoch(Sample* s, Chance* chance) {
  const Utime by = std::llround(std::pow(10, Draw(chance, 7, 15)));
  const bool truth = Pick(chance, 2) == 0;
  for (ImuSample& i : s->imu) i.t += by;
  for (StampedPose& p : s->truth) p.t += truth ? by : 0;
  return FormatText("the IMU's clock began %.0f s earlier", ToSeconds(by));
}

// The events' clock against that of IMU and truth.
std::string OffsetOfClocks(Sample* s, Chance* chance) {
  const Utime by =
      std::llround(Either(chance, -1, 1) * std::exp(Draw(chance, std::log(30e3), std::log(600e3))));
  for (Utime& t : s->events.t) t += by;
  return FormatText("clocks %+.0f ms apart", 1e3 * ToSeconds(by));
}

std::string DriftOfClocks(Sample* s, Chance* chance) {
  const double drift = Either(chance, -1, 1) * Draw(chance, 0.02, 0.06);
  const Utime first = s->events.t.front();
  for (Utime& t : s->events.t) t = first + std::llround((1 + drift) * static_cast<double>(t - first));
  return FormatText("clocks drift apart by %+.0f ms a second", 1e3 * drift);
}

// The same way, many times slower, with as many IMU samples and poses a second.
std::string SlowDown(Sample* s, Chance* chance) {
  const int n = 10 + Pick(chance, 11);
  const Utime origin = s->events.t.front();
  const auto later = [&](Utime t) { return origin + n * (t - origin); };
  for (Utime& t : s->events.t) t = later(t);
  Trajectory truth;
  std::vector<ImuSample> imu;
  for (std::size_t k = 0; k + 1 < s->truth.size(); ++k) {
    const StampedPose &a = s->truth[k], &b = s->truth[k + 1];
    for (int part = 0; part < n; ++part) {
      const double share = static_cast<double>(part) / n;
      truth.push_back({later(a.t) + part * (b.t - a.t),
                       SE3(a.pose.q.slerp(share, b.pose.q), a.pose.p + share * (b.pose.p - a.pose.p))});
    }
  }
  for (std::size_t k = 0; k + 1 < s->imu.size(); ++k) {
    const ImuSample &a = s->imu[k], &b = s->imu[k + 1];
    SE3 pose;
    if (!PoseAt(s->truth, a.t, &pose)) continue;
    const Eigen::Vector3d g = pose.q.conjugate() * Eigen::Vector3d(0, 0, s->rig.gravity);
    for (int part = 0; part < n; ++part) {
      const double share = static_cast<double>(part) / n;
      imu.push_back({later(a.t) + part * (b.t - a.t), (a.gyro + share * (b.gyro - a.gyro)) / n,
                     g + (a.accel + share * (b.accel - a.accel) - g) / (n * n)});
    }
  }
  s->truth = std::move(truth), s->imu = std::move(imu);
  return FormatText("%d times slower", n);
}

}  // namespace

std::vector<RandomFault> RandomImuFaults() {
  return {{"motion too slow", {"motion", "event-rate"}, SlowDown},
          {"accelerometer's unit", {"imu-accel-unit"}, AccelUnit},
          {"gyro's unit", {"imu-gyro-unit"}, GyroUnit},
          {"gravity removed", {"imu-accel-unit"}, RemoveGravity},
          {"IMU axes swapped", {"imu-gyro-axes", "imu-accel-axes", "gravity", "truth-frame"}, SwapAxes},
          {"IMU axis mirrored", {"imu-gyro-axes", "imu-accel-axes", "gravity"}, MirrorAxis},
          {"IMU cut off", {"imu-saturation"}, Saturate},
          {"IMU noise", {"imu-noise"}, ShakeImu},
          {"gyro bias", {"imu-gyro-bias"}, BiasGyro},
          {"accelerometer's scale", {"imu-accel-scale"}, ScaleAccel},
          {"IMU too slow", {"imu-rate"}, SlowImu},
          {"IMU samples lost", {"imu-gaps", "imu-rate"}, LoseImu},
          {"IMU out of order", {"imu-order"}, SpoilImuOrder},
          {"unit of IMU stamps", {"imu-stamps"}, ScaleImuStamps},
          {"two epochs", {"clocks"}, OtherEpoch},
          {"time offset", {"time-offset"}, OffsetOfClocks},
          {"clocks drift", {"clocks", "time-offset", "clock-drift"}, DriftOfClocks}};
}

}  // namespace evit::doctor
