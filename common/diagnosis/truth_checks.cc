#include "common/diagnosis/truth_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/diagnosis/rate_fit.h"
#include "common/diagnosis/sample_integral.h"
#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kMostBias = 0.12;               // rad/s: 7 deg/s; consumer sensors have up to 3
constexpr Utime kHalf = 25'000, kStep = 20'000;  // us

Finding Span(const Trajectory& truth, const std::vector<ImuSample>& imu) {
  const auto [first, last] = std::minmax_element(
      imu.begin(), imu.end(), [](const ImuSample& a, const ImuSample& b) { return a.t < b.t; });
  const double both = ToSeconds(std::min(truth.back().t, last->t) - std::max(truth.front().t, first->t));
  const double needed =
      0.3 * std::min(ToSeconds(last->t - first->t), ToSeconds(truth.back().t - truth.front().t));
  const std::string figure =
      FormatText("truth %.3f to %.3f s, IMU %.3f to %.3f s", ToSeconds(truth.front().t),
                 ToSeconds(truth.back().t), ToSeconds(first->t), ToSeconds(last->t));
  if (both <= needed) {
    return {"truth-span", Severity::kError, figure,
            "The truth's poses and the recording barely overlap in time.",
            "give the truth of this recording, in seconds of the IMU's clock"};
  }
  return Good("truth-span", figure);
}

// The mean of what the accelerometer reads, in the map, with its axes turned by R's inverse; zero where there
// are too few poses.
Eigen::Vector3d Up(const Trajectory& truth, const std::vector<ImuSample>& imu, Utime lag,
                   const Eigen::Matrix3d& R = Eigen::Matrix3d::Identity()) {
  const SampleIntegral force(imu, false);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int n = 0;
  for (Utime t = truth.front().t + kHalf; t + kHalf <= truth.back().t; t += kStep) {
    SE3 pose;
    Eigen::Vector3d mean;
    if (!PoseAt(truth, t, &pose) || !force.Mean(t + lag - kHalf, t + lag + kHalf, &mean)) continue;
    sum += pose.q * (R.transpose() * mean), ++n;
  }
  return n < 20 ? Eigen::Vector3d::Zero() : sum.normalized();
}

// Whether gravity lies as it should with the accelerometer's axes as they are, but not with those that the
// gyro would have: then the gyro alone is turned, not the body.
bool OnlyGyroIsTurned(const Trajectory& truth, const std::vector<ImuSample>& imu, const RateFit& fit) {
  return Up(truth, imu, fit.lag).z() > 0.99 && Up(truth, imu, fit.lag, fit.R).z() < 0.95;
}

Finding Rotation(const RateFit& fit, const Trajectory& truth, const std::vector<ImuSample>& imu) {
  // Rotation about one axis leaves a turn about that open: only one that explains more counts.
  const bool turned = fit.explained > fit.explained_unturned + 0.015;
  const double angle =
      turned ? kDegreesPerRadian * AngularDistance(Eigen::Quaterniond(fit.R), Eigen::Quaterniond::Identity())
             : 0;
  const std::string figure =
      FormatText("the gyro's rates fit the truth's to %.0f %%, at %+.0f ms, scale %.3g", 100 * fit.explained,
                 1e3 * ToSeconds(fit.lag), fit.scale);
  if (fit.n < 20 || (fit.rate < 0.05 && fit.explained < 0.9))
    return Good("truth-rotation", figure + "; too little rotation to tell");
  if (fit.explained < 0.5) {
    return {"truth-rotation", Severity::kError, figure,
            "The truth does not turn as the gyro does, at any time offset up to a second.",
            "is it the truth of this recording? are its quaternions x y z w, and its poses body to map?"};
  }
  if (std::abs(fit.scale - kDegreesPerRadian) < 6 || std::abs(fit.scale * kDegreesPerRadian - 1) < 0.1) {
    return {"imu-gyro-unit", Severity::kError, figure,
            fit.scale > 1 ? "The gyro is in degrees per second, not in rad/s."
                          : "The gyro was converted from degrees twice.",
            fit.scale > 1 ? "multiply by 0.0174533 where the recording is made or converted"
                          : "record it in rad/s"};
  }
  if (fit.scale < 0.8 || fit.scale > 1.25) {
    return {"imu-gyro-unit", Severity::kError, figure, "The gyro's scale is wrong.",
            "look at the sensor's full-scale setting, and at the unit"};
  }
  if (fit.R.determinant() < 0) {
    return {"imu-gyro-axes", Severity::kError, figure, "The gyro turns the other way round about some axis.",
            "give gyro and accelerometer in one right-handed body frame"};
  }
  if (angle > 8 && OnlyGyroIsTurned(truth, imu, fit)) {
    return {"imu-gyro-axes", Severity::kError, figure + FormatText(", turned by %.0f deg", angle),
            FormatText("The gyro's axes are turned by %.0f deg against the accelerometer's.", angle),
            "give gyro and accelerometer in one right-handed body frame"};
  }
  if (angle > 8) {
    return {"truth-frame", Severity::kError, figure + FormatText(", turned by %.0f deg", angle),
            FormatText("The truth's body frame is turned by %.0f deg against the IMU's: it is a marker "
                       "body's, or the camera's.",
                       angle),
            "import the truth with the rig file's T_marker_body set, or give poses of the IMU"};
  }
  if (fit.bias.norm() > kMostBias) {
    return {
        "imu-gyro-bias", Severity::kWarning, figure + FormatText(", bias %.2f rad/s", fit.bias.norm()),
        FormatText("The gyro reads (%.2f, %.2f, %.2f) rad/s more than the truth turns: far more than a bias "
                   "of a sensor that works.",
                   fit.bias.x(), fit.bias.y(), fit.bias.z()),
        "let the driver calibrate the gyro at rest, or subtract that; a sensor with it may be broken"};
  }
  if (std::abs(fit.lag) >= 15'000 && fit.explained > fit.explained_as_is + 0.02) {
    return {"truth-time", Severity::kWarning, figure,
            FormatText("The truth's clock is %.0f ms off the IMU's.", 1e3 * ToSeconds(fit.lag)),
            FormatText("add %.3f s to the truth's stamps", ToSeconds(fit.lag))};
  }
  return Good("truth-rotation", figure);
}

Finding Gravity(const Trajectory& truth, const std::vector<ImuSample>& imu, const RateFit& fit) {
  const Eigen::Vector3d up = Up(truth, imu, fit.lag);
  if (up.isZero()) return Good("gravity", "too few poses to tell");
  const double tilt = kDegreesPerRadian * std::acos(std::clamp(up.z(), -1.0, 1.0));
  const std::string figure = FormatText("the accelerometer's mean is %.1f deg off the map's z axis", tilt);
  if (tilt > 150) {
    return {"gravity", Severity::kError, figure,
            "The accelerometer points down: its sign is turned (it must read +9.8 upwards at rest), or the "
            "map hangs upside down.",
            "negate the accelerometer, or turn the map with `evit map import --transform`"};
  }
  if (tilt > 5) {
    return {"gravity", tilt > 15 ? Severity::kError : Severity::kWarning, figure,
            FormatText("Gravity is %.0f deg off the map's -z axis (up is %.2f %.2f %.2f in the map).", tilt,
                       up.x(), up.y(), up.z()),
            "turn map and truth so that z is up: `evit map import --transform`"};
  }
  return Good("gravity", figure);
}

// Whether the gyro contradicts the poses, and fits their inverses.
bool IsInverted(const RateFit& fit, const Trajectory& truth, const std::vector<ImuSample>& imu) {
  if (fit.n < 20 || fit.rate < 0.05 || fit.explained_unturned > 0.5) return false;
  Trajectory inverse = truth;
  for (StampedPose& s : inverse) s.pose = s.pose.Inverse();
  return FitRates(inverse, imu, 0).explained_unturned > 0.9;
}

}  // namespace

Findings CheckTruth(const Trajectory& truth, const std::vector<ImuSample>& imu) {
  if (truth.size() < 2 || imu.size() < 20) return {};
  Findings found{Span(truth, imu)};
  if (found.back().severity != Severity::kGood) return found;
  const RateFit fit = FitRates(truth, imu);
  if (IsInverted(fit, truth, imu)) {
    found.push_back(
        {"truth-frame", Severity::kError,
         FormatText("the gyro's rates fit the truth's to %.0f %% in its axes", 100 * fit.explained_unturned),
         "The truth's poses are inverted: they take points from the map to the body, not from the body "
         "to the map.",
         "invert the poses of the truth"});
    return found;
  }
  found.push_back(Rotation(fit, truth, imu));
  // With the body turned or another's motion, what gravity seems to do says nothing.
  if (found.back().severity != Severity::kError) found.push_back(Gravity(truth, imu, fit));
  return found;
}

}  // namespace evit::diagnosis
