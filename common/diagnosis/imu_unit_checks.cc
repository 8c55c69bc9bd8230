#include "common/diagnosis/imu_unit_checks.h"

#include <algorithm>
#include <cmath>

#include "common/diagnosis/gravity_consistency.h"
#include "common/diagnosis/median.h"
#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

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

}  // namespace

Finding CheckAccelUnit(const std::vector<ImuSample>& samples, double gravity) {
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
  // Shaken hard, it reads more than gravity, up and down; in another unit it would do so on average too, and
  // without gravity nothing is left on average.
  const double calm = ForceWithoutShaking(samples);
  const bool shaken = spread > 0.2 * median;
  if (std::abs(median / gravity - 1) < 0.2 && !(shaken && calm < 0.5 * gravity))
    return Good("imu-accel-unit", figure);
  if (std::abs(calm / gravity - 1) < 0.2) return Good("imu-accel-unit", figure + ", shaken");
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
  if (std::min(median, calm) < 0.6 * gravity) {
    return {"imu-accel-unit", Severity::kError, figure,
            "Gravity was taken out of the accelerometer's readings (a \"linear acceleration\").",
            "record the raw specific force: at rest it must read 9.8 m/s^2 upwards"};
  }
  if (calm < 1.5 * gravity) {  // nearer than any unit
    return {"imu-accel-scale", Severity::kError, figure,
            FormatText("The accelerometer reads %.0f %% %s gravity: its scale is wrong.",
                       100 * std::abs(calm / gravity - 1), calm > gravity ? "more than" : "less than"),
            FormatText("look at the full-scale setting of sensor and driver, or multiply by %.3f",
                       gravity / calm)};
  }
  return {"imu-accel-unit", Severity::kError, figure,
          "The accelerometer's unit is not m/s^2, or its scale is wrong.",
          "convert it to m/s^2: at rest the norm must be 9.8"};
}

Finding CheckGyroUnit(const std::vector<ImuSample>& samples) {
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

}  // namespace evit::diagnosis
