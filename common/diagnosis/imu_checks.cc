#include "common/diagnosis/imu_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/diagnosis/imu_unit_checks.h"
#include "common/diagnosis/median.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

// Times between samples, s, of those in order.
std::vector<double> Steps(const std::vector<ImuSample>& samples) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < samples.size(); ++k)
    if (samples[k].t > samples[k - 1].t) steps.push_back(ToSeconds(samples[k].t - samples[k - 1].t));
  return steps;
}

Finding Order(const std::vector<ImuSample>& samples) {
  std::size_t wrong = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) wrong += samples[k].t <= samples[k - 1].t ? 1 : 0;
  const double share = static_cast<double>(wrong) / static_cast<double>(samples.size());
  const std::string figure = FormatText("%zu stamps out of order", wrong);
  if (wrong == 0) return Good("imu-order", figure);
  return {"imu-order", share > 0.02 ? Severity::kError : Severity::kWarning, figure,
          FormatText("%.1f %% of the IMU's stamps repeat or go back.", 100 * share),
          "stamp samples in the driver by the sensor's own clock, not by the time of arrival"};
}

Finding Rate(const std::vector<double>& steps, const Rig& rig) {
  const double rate = 1 / Median(steps);
  const std::string figure = FormatText("%.0f samples/s; the rig file says %.0f", rate, rig.imu_rate_hz);
  if (rate < 80) {
    return {"imu-rate", rate < 40 ? Severity::kError : Severity::kWarning, figure,
            "The IMU is too slow for hand-held motion.", "let the driver deliver 200 Hz or more"};
  }
  if (std::abs(rate / rig.imu_rate_hz - 1) > 0.15) {
    return {"imu-rate", Severity::kWarning, figure,
            "The IMU does not have the rate that the rig file states.",
            FormatText("set `imu.rate_hz: %.0f` in the rig file, if no samples are lost", rate)};
  }
  return Good("imu-rate", figure);
}

Finding Gaps(const std::vector<double>& steps) {
  const double usual = Median(steps);
  double longest = 0, missing = 0, whole = 0;
  for (const double dt : steps) {
    longest = std::max(longest, dt), whole += dt;
    if (dt > 1.6 * usual) missing += dt - usual;
  }
  const std::string figure =
      FormatText("longest gap %.1f ms, %.1f %% of the samples missing", 1e3 * longest, 100 * missing / whole);
  if (longest > 0.1 || missing > 0.2 * whole) {
    return {"imu-gaps", Severity::kError, figure,
            "IMU samples are missing; tracking restarts at each longer gap.",
            "look for losses between sensor and log: a slow serial line, a full disk, dropped packets"};
  }
  if (longest > 6 * usual && longest > 0.02) {
    return {"imu-gaps", Severity::kWarning, figure, "Some IMU samples are missing.",
            "look for losses between sensor and log"};
  }
  return Good("imu-gaps", figure);
}

// Share of the readings below the largest that are the same as the one before.
template <typename Value>
double RepeatsBelow(const std::vector<ImuSample>& samples, const Value& value, double largest) {
  double n = 0, same = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double now = value(samples[k]);
    if (now < largest) n += 1, same += now == value(samples[k - 1]) ? 1 : 0;
  }
  return n > 0 ? same / n : 1;
}

// Readings that stay at one extreme value: cut off there, whatever the rig file says.
Finding Saturation(const std::vector<ImuSample>& samples, const ImuNoise& limits) {
  std::size_t cut = 0;
  std::vector<bool> any(samples.size(), false);
  double at_gyro = 0, at_accel = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const bool gyro = axis < 3;
    const auto value = [gyro, axis](const ImuSample& s) {
      return std::abs(gyro ? s.gyro[axis] : s.accel[axis - 3]);
    };
    double largest = 0;
    for (const ImuSample& s : samples) largest = std::max(largest, value(s));
    const double range = gyro ? limits.gyro_range : limits.accel_range;
    // A reading that rests at its extreme, in steps of the sensor, is not a clipped motion; one that stays
    // there to the last digit, and nowhere else, is.
    const bool small = largest < (gyro ? 1.0 : 12.0);
    if (small && RepeatsBelow(samples, value, largest) > 0.01) continue;
    const double extreme = (small ? 1 : 0.9999) * largest;
    std::size_t at = 0, run = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      run = value(samples[k]) >= extreme || value(samples[k]) >= 0.99 * range ? run + 1 : 0;
      if (run < 3) continue;
      at += run == 3 ? 3 : 1;
      for (std::size_t back = 0; back < 3; ++back) any[k - back] = true;
    }
    if (at > 0) (gyro ? at_gyro : at_accel) = largest;
    cut += at;
  }
  const double share =
      static_cast<double>(std::count(any.begin(), any.end(), true)) / static_cast<double>(samples.size());
  const std::string figure = FormatText("%zu readings cut off", cut);
  if (cut == 0) return Good("imu-saturation", figure);
  return {"imu-saturation", share > 0.02 ? Severity::kError : Severity::kWarning, figure,
          FormatText("The %s is at its limit (%.3g) %.1f %% of the time.",
                     at_gyro > 0 ? "gyro" : "accelerometer", at_gyro > 0 ? at_gyro : at_accel, 100 * share),
          "set a wider range in the sensor, and `imu.gyro_range` and `imu.accel_range` in the rig file to "
          "what it is"};
}

// Of the quietest tenth of a second: the deviation from a line through the neighbours, which motion hardly
// has.
double Noise(const std::vector<ImuSample>& samples, bool gyro) {
  constexpr std::size_t kPart = 100;
  double quietest = 0;
  for (std::size_t begin = 0; begin + kPart <= samples.size(); begin += kPart) {
    double sum = 0;
    for (std::size_t k = begin + 1; k + 1 < begin + kPart; ++k) {
      const auto of = [gyro](const ImuSample& s) -> const Eigen::Vector3d& {
        return gyro ? s.gyro : s.accel;
      };
      sum += (of(samples[k]) - (of(samples[k - 1]) + of(samples[k + 1])) / 2).squaredNorm();
    }
    // Of white noise s^2 in 3 axes the deviation has 4.5 s^2.
    const double sigma = std::sqrt(sum / (kPart - 2) / 4.5);
    if (begin == 0 || sigma < quietest) quietest = sigma;
  }
  return quietest;
}

Finding NoiseOf(const std::vector<ImuSample>& samples, const std::vector<double>& steps,
                const ImuNoise& noise) {
  const double root = std::sqrt(Median(steps));
  const double gyro = Noise(samples, true) * root, accel = Noise(samples, false) * root;
  const double more = std::max(gyro / noise.gyro_density, accel / noise.accel_density);
  const std::string figure =
      FormatText("when calmest, %.1f (gyro) and %.1f (accelerometer) times the rig file's noise",
                 gyro / noise.gyro_density, accel / noise.accel_density);
  if (samples.size() > 200 && more > 7) {
    return {"imu-noise", Severity::kWarning, figure,
            "The IMU is far noisier than the rig file says: vibration, or another sensor's figures.",
            "mount it on rubber; take the densities from its data sheet or from a recording at rest (Allan "
            "deviation)"};
  }
  return Good("imu-noise", figure);
}

}  // namespace

Findings CheckImu(const std::vector<ImuSample>& samples, const Rig& rig) {
  if (samples.empty()) {
    return {
        {"imu-rate", Severity::kWarning, "no samples",
         "The recording holds no IMU. EVIT needs one; tracking by events alone does not.",
         "record the IMU beside the events (`evit import --help` says how a file of its own is given), or "
         "run with --config config/evt.textproto and a start pose"}};
  }
  if (samples.size() < 20) {
    return {{"imu-rate", Severity::kError, FormatText("%zu samples", samples.size()),
             "The recording holds no IMU samples to speak of.",
             "record the IMU beside the events; `evit import --help` says how a file of its own is given"}};
  }
  const std::vector<double> steps = Steps(samples);
  if (steps.size() < 10) {
    return {{"imu-order", Severity::kError, "no two stamps in order",
             "All IMU samples have one stamp, or go back.",
             "look at the unit of the stamps where the recording was made or converted"}};
  }
  return {Order(samples),
          Rate(steps, rig),
          Gaps(steps),
          CheckAccelUnit(samples, rig.gravity),
          CheckGyroUnit(samples),
          Saturation(samples, rig.imu_noise),
          NoiseOf(samples, steps, rig.imu_noise)};
}

}  // namespace evit::diagnosis
