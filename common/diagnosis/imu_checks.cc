#include "common/diagnosis/imu_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/diagnosis/gravity_consistency.h"
#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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

// The norm of the mean force over half a second, in which shaking cancels and gravity does not; its median.
double ForceWithoutShaking(const std::vector<ImuSample>& samples) {
  constexpr Utime kWindow = 500'000;  // us: some periods of a hand's tremor
  std::vector<double> norms;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Utime begin = samples.front().t;
  int n = 0;
  for (const ImuSample& s : samples) {
    if (s.t - begin >= kWindow) {
      norms.push_back(sum.norm() / n);
      sum = Eigen::Vector3d::Zero();
      begin = s.t;
      n = 0;
    }
    sum += s.accel;
    ++n;
  }
  return norms.empty() ? sum.norm() / n : Median(norms);
}

Finding AccelUnit(const std::vector<ImuSample>& samples, double gravity) {
  std::vector<double> norms;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0;
  for (const ImuSample& s : samples) {
    norms.push_back(s.accel.norm());
    sum += s.accel;
    squares += s.accel.squaredNorm();
  }
  const double n = static_cast<double>(samples.size()), median = Median(norms);
  double spread = 0;
  for (const double a : norms) spread += std::abs(a - median) / n;
  const double rms = std::sqrt(squares / n), steady = sum.norm() / n / std::max(rms, 1e-12);
  const std::string figure = FormatText("specific force %.3g m/s^2 (median), gravity %.2f", median, gravity);
  if (std::abs(median / gravity - 1) < 0.2) return Good("imu-accel-unit", figure);
  // Shaken hard, it reads more than gravity, up and down; in another unit it would do so on average too.
  const bool shaken = median > gravity && spread > 0.2 * median;
  if (shaken && std::abs(ForceWithoutShaking(samples) / gravity - 1) < 0.2)
    return Good("imu-accel-unit", figure + ", shaken");
  struct Unit {
    const char* name;
    double g;
  };
  for (const Unit unit :
       {Unit{"g", 1}, Unit{"mg", 1000}, Unit{"mm/s^2", 1000 * gravity}, Unit{"cm/s^2", 100 * gravity},
        Unit{"g (multiplied by g twice)", gravity * gravity}}) {
    if (std::abs(median / unit.g - 1) < 0.15 && spread < 0.35 * median && (unit.g > 2 || steady > 0.6)) {
      return {"imu-accel-unit", Severity::kError, figure,
              FormatText("The accelerometer is in %s, not in m/s^2.", unit.name),
              FormatText("multiply by %.6g where the recording is made or converted", gravity / unit.g)};
    }
  }
  if (median < 0.6 * gravity) {
    return {"imu-accel-unit", Severity::kError, figure,
            "Gravity was taken out of the accelerometer's readings (a \"linear acceleration\").",
            "record the raw specific force: at rest it must read 9.8 m/s^2 upwards"};
  }
  return {"imu-accel-unit", Severity::kError, figure,
          "The accelerometer's unit is not m/s^2, or its scale is wrong.",
          "convert it to m/s^2: at rest the norm must be 9.8"};
}

Finding GyroUnit(const std::vector<ImuSample>& samples) {
  std::vector<double> norms;
  norms.reserve(samples.size());
  for (const ImuSample& s : samples) norms.push_back(s.gyro.norm());
  const double median = Median(norms);
  const GyroFit fit = FitGyroToGravity(samples);
  const std::string figure =
      fit.pairs > 0 ? FormatText("%.2g rad/s (median); gravity turned by %.0f deg, gyro differs by %.0f deg",
                                 median, kDegreesPerRadian * fit.without, kDegreesPerRadian * fit.as_read)
                    : FormatText("%.2g rad/s (median)", median);
  // 8 rad/s, 460 deg/s, for half of the time: no hand and no robot with a camera.
  if ((fit.Contradicted() && fit.InDegrees()) || median > 8) {
    return {"imu-gyro-unit", Severity::kError, figure, "The gyro is in degrees per second, not in rad/s.",
            "multiply by 0.0174533 where the recording is made or converted"};
  }
  if (fit.Contradicted()) {
    const bool mirrored = fit.axes.determinant() < 0;
    return {"imu-gyro-axes", Severity::kError, figure,
            mirrored ? "The gyro's sense of rotation, or an axis of gyro or accelerometer, is turned around."
                     : "Gyro and accelerometer do not have the same axes.",
            "give both in one right-handed body frame, as the rig file's T_body_camera has it"};
  }
  if (median < 1e-6) {
    return {"imu-gyro-unit", Severity::kError, figure, "The gyro reads zero.",
            "look at which fields the recording was made from"};
  }
  return Good("imu-gyro-unit", figure);
}

// Readings that stay at one extreme value: cut off there, whatever the rig file says.
Finding Saturation(const std::vector<ImuSample>& samples, const ImuNoise& limits) {
  std::size_t cut = 0;
  double at_gyro = 0, at_accel = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const bool gyro = axis < 3;
    const auto value = [gyro, axis](const ImuSample& s) {
      return std::abs(gyro ? s.gyro[axis] : s.accel[axis - 3]);
    };
    double largest = 0;
    for (const ImuSample& s : samples) largest = std::max(largest, value(s));
    const double range = gyro ? limits.gyro_range : limits.accel_range;
    std::size_t at = 0, run = 0;
    for (const ImuSample& s : samples) {
      run = value(s) >= 0.9999 * largest || value(s) >= 0.99 * range ? run + 1 : 0;
      at += run == 3 ? 3 : run > 3 ? 1 : 0;
    }
    if (largest < (gyro ? 1.0 : 12.0))
      continue;  // a reading that rests at its extreme is not a clipped motion
    if (at > 0) (gyro ? at_gyro : at_accel) = largest;
    cut += at;
  }
  const double share = static_cast<double>(cut) / static_cast<double>(samples.size());
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
  if (samples.size() > 200 && more > 20) {
    return {"imu-noise", Severity::kWarning, figure,
            "The IMU is far noisier than the rig file says: vibration, or another sensor's figures.",
            "mount it on rubber; take the densities from its data sheet or from a recording at rest (Allan "
            "deviation)"};
  }
  return Good("imu-noise", figure);
}

}  // namespace

Findings CheckImu(const std::vector<ImuSample>& samples, const Rig& rig) {
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
          AccelUnit(samples, rig.gravity),
          GyroUnit(samples),
          Saturation(samples, rig.imu_noise),
          NoiseOf(samples, steps, rig.imu_noise)};
}

}  // namespace evit::diagnosis
