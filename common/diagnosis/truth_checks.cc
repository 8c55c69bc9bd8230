#include "common/diagnosis/truth_checks.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr Utime kHalf = 25'000, kStep = 20'000, kLagStep = 5'000;  // us

struct Rates {
  Utime t;
  Eigen::Vector3d of_truth;  // rad/s over [t - kHalf, t + kHalf], body axes
};

std::vector<Rates> RatesOf(const Trajectory& truth) {
  std::vector<Rates> rates;
  if (truth.size() < 2) return rates;
  for (Utime t = truth.front().t + kHalf; t + kHalf <= truth.back().t; t += kStep) {
    SE3 a, b;
    if (!PoseAt(truth, t - kHalf, &a) || !PoseAt(truth, t + kHalf, &b)) continue;
    rates.push_back({t, LogSO3(a.q.conjugate() * b.q) / ToSeconds(2 * kHalf)});
  }
  return rates;
}

/// Integrals over time of a gyro or an accelerometer, so that any mean costs two look-ups.
class Integral {
 public:
  Integral(const std::vector<ImuSample>& samples, bool gyro) {
    for (const ImuSample& s : samples) {
      const Eigen::Vector3d& v = gyro ? s.gyro : s.accel;
      if (!times_.empty() && s.t <= times_.back()) continue;
      if (times_.empty()) {
        sums_.push_back(Eigen::Vector3d::Zero());
      } else {
        sums_.push_back(sums_.back() + ToSeconds(s.t - times_.back()) * (v + last_) / 2);
      }
      times_.push_back(s.t);
      last_ = v;
    }
  }
  /// Mean over the time; false where it is not covered.
  bool Mean(Utime begin, Utime end, Eigen::Vector3d* mean) const {
    if (times_.size() < 2 || begin < times_.front() || end > times_.back()) return false;
    *mean = (At(end) - At(begin)) / ToSeconds(end - begin);
    return true;
  }

 private:
  Eigen::Vector3d At(Utime t) const {
    const auto it = std::lower_bound(times_.begin(), times_.end(), t);
    const auto k = static_cast<std::size_t>(it - times_.begin());
    if (k == 0) return sums_.front();
    const double share = ToSeconds(t - times_[k - 1]) / ToSeconds(times_[k] - times_[k - 1]);
    return sums_[k - 1] + share * (sums_[k] - sums_[k - 1]);
  }
  std::vector<Utime> times_;
  std::vector<Eigen::Vector3d> sums_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

// The best R and scale at one lag, by the singular values of the cross-covariance (Kabsch).
RateFit FitAt(const std::vector<Rates>& rates, const Integral& gyro, Utime lag) {
  RateFit fit;
  fit.lag = lag;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  for (const Rates& r : rates) {
    Eigen::Vector3d measured;
    if (!gyro.Mean(r.t + lag - kHalf, r.t + lag + kHalf, &measured)) continue;
    pairs.emplace_back(r.of_truth, measured);
    mean_a += r.of_truth, mean_b += measured;
  }
  fit.n = static_cast<int>(pairs.size());
  if (fit.n < 20) return fit;
  mean_a /= fit.n, mean_b /= fit.n;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  double aa = 0, bb = 0;
  for (const auto& [a, b] : pairs) {
    cross += (b - mean_b) * (a - mean_a).transpose();
    aa += (a - mean_a).squaredNorm(), bb += (b - mean_b).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  fit.R = svd.matrixU() * svd.matrixV().transpose();
  // A mirror image only where it explains clearly more: rotation about one axis leaves the sign of another
  // open.
  const double mirrored = svd.singularValues().sum();
  if (fit.R.determinant() < 0) {
    const Eigen::Vector3d keep(1, 1, -1);
    const double proper = svd.singularValues().dot(keep);
    if (proper > 0.8 * mirrored) fit.R = svd.matrixU() * keep.asDiagonal() * svd.matrixV().transpose();
  }
  const double agreement = (fit.R.transpose() * cross).trace();
  fit.rate = std::sqrt(aa / fit.n);
  fit.scale = agreement / std::max(aa, 1e-12);
  fit.explained = agreement > 0 ? agreement * agreement / std::max(aa * bb, 1e-18) : 0;
  return fit;
}

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
  const Integral force(imu, false);
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
  const double angle =
      kDegreesPerRadian * AngularDistance(Eigen::Quaterniond(fit.R), Eigen::Quaterniond::Identity());
  const std::string figure =
      FormatText("the gyro's rates fit the truth's to %.0f %%, at %+.0f ms, scale %.3g", 100 * fit.explained,
                 1e3 * ToSeconds(fit.lag), fit.scale);
  if (fit.n < 20 || fit.rate < 0.05) return Good("truth-rotation", figure + "; too little rotation to tell");
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

}  // namespace

RateFit FitRates(const Trajectory& truth, const std::vector<ImuSample>& imu, Utime reach) {
  const std::vector<Rates> rates = RatesOf(truth);
  const Integral gyro(imu, true);
  const RateFit as_is = FitAt(rates, gyro, 0);
  RateFit best = as_is;
  for (Utime lag = -reach; lag <= reach; lag += kLagStep) {
    const RateFit fit = FitAt(rates, gyro, lag);
    // A lag that leaves little overlap proves nothing.
    if (2 * fit.n >= as_is.n && fit.n >= 50 && fit.explained > best.explained) best = fit;
  }
  best.explained_as_is = as_is.explained;
  return best;
}

Findings CheckTruth(const Trajectory& truth, const std::vector<ImuSample>& imu) {
  if (truth.size() < 2 || imu.size() < 20) return {};
  Findings found{Span(truth, imu)};
  if (found.back().severity != Severity::kGood) return found;
  const RateFit fit = FitRates(truth, imu);
  found.push_back(Rotation(fit, truth, imu));
  // With the body turned or another's motion, what gravity seems to do says nothing.
  if (found.back().severity != Severity::kError) found.push_back(Gravity(truth, imu, fit));
  return found;
}

}  // namespace evit::diagnosis
