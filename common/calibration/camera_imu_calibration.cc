#include "common/calibration/camera_imu_calibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/calibration/rate_alignment.h"

namespace evit {
namespace {

constexpr Utime kMaxOffset = 100'000, kMaxImuGap = 50'000;  // us
constexpr Utime kShortestStep = 10'000;                     // us between poses: two samples of a 200 Hz IMU
constexpr std::size_t kMostPoses = 3000, kFewestPoses = 100;
constexpr double kShortest = 3;        // s
constexpr double kImuNoiseFactor = 2;  // as in tracking: integration error and vibration
constexpr double kOutlier = 5;         // sigmas of one axis
constexpr double kHold = 1e-6;         // m, rad, s: sigma of what is held at the rig file's figure
// Standard deviations above which a value counts as not observable.
constexpr double kMaxTranslation = 0.015, kMaxRotation = 0.007, kMaxOffsetSigma = 1e-3;  // m, rad, s
constexpr double kMaxGyroBias = 0.01, kMaxAccelBias = 0.05, kMaxTilt = 0.005;            // rad/s, m/s^2, rad
constexpr PoseNoise kStiff{0.03, 0.01, 1, 1};  // poses that count so little that the IMU shapes the motion
// What a rig file's figures may be off by.
constexpr double kTranslationPrior = 0.2, kRotationPrior = 0.2;  // m, rad

Trajectory Thin(const Trajectory& camera, const ImuTrack& imu) {
  Trajectory covered;
  for (const StampedPose& s : camera) {
    if (imu.Covers(s.t - 2 * kMaxOffset) && imu.Covers(s.t + 2 * kMaxOffset)) covered.push_back(s);
  }
  if (covered.empty()) return covered;
  const Utime step =
      std::max(kShortestStep, (covered.back().t - covered.front().t) / static_cast<Utime>(kMostPoses));
  Trajectory thin;
  for (const StampedPose& s : covered) {
    if (thin.empty() || s.t - thin.back().t >= step) thin.push_back(s);
  }
  return thin;
}

// Where the closed form knows more than the rig file.
CameraImuValues Start(const RateAlignment& rates, const Rig& rig) {
  CameraImuValues start;
  start.T_body_camera = rig.T_body_camera;
  const double root_n = std::sqrt(static_cast<double>(rates.n));
  const bool turns = rates.spread[0] > 0.05 && rates.rms < 0.5 * rates.spread[0];
  if (turns) start.offset = rates.offset;
  if (turns && rates.spread[1] > 0.05 && rates.rms / (root_n * rates.spread[1]) < 0.02) {
    start.T_body_camera.q = rates.q_body_camera;
    start.bias.gyro = rates.gyro_bias;
  }
  return start;
}

// Directions of which a 3x3 covariance says too little.
void FindUnobservable(const Eigen::Matrix3d& covariance, double largest, Unobservable::Value value,
                      std::vector<Unobservable>* out) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  for (int k = 2; k >= 0; --k) {
    const double sigma = std::sqrt(std::max(0.0, axes.eigenvalues()[k]));
    if (sigma > largest) out->push_back({value, axes.eigenvectors().col(k), sigma});
  }
}

std::vector<Unobservable> FindUnobservable(const CameraImuCovariance& P) {
  std::vector<Unobservable> out;
  using Value = Unobservable::Value;
  FindUnobservable(P.block<3, 3>(0, 0), kMaxTranslation, Value::kTranslation, &out);
  FindUnobservable(P.block<3, 3>(3, 3), kMaxRotation, Value::kRotation, &out);
  const double offset = std::sqrt(P(6, 6));
  if (offset > kMaxOffsetSigma) out.push_back({Value::kTimeOffset, Eigen::Vector3d::Zero(), offset});
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Zero();
  tilt.topLeftCorner<2, 2>() = P.block<2, 2>(7, 7);
  FindUnobservable(tilt, kMaxTilt, Value::kTilt, &out);
  FindUnobservable(P.block<3, 3>(9, 9), kMaxGyroBias, Value::kGyroBias, &out);
  FindUnobservable(P.block<3, 3>(12, 12), kMaxAccelBias, Value::kAccelBias, &out);
  return out;
}

// Adds what holds the rig file's figures in these directions; false where there is nothing to hold.
bool Hold(const std::vector<Unobservable>& unobservable, CameraImuPrior* prior) {
  bool any = false;
  for (const Unobservable& u : unobservable) {
    const Eigen::Matrix3d hold = u.direction * u.direction.transpose() / (kHold * kHold);
    if (u.value == Unobservable::Value::kTranslation) {
      prior->position_information += hold;
    } else if (u.value == Unobservable::Value::kRotation) {
      prior->rotation_information += hold;
    } else if (u.value == Unobservable::Value::kTimeOffset) {
      prior->offset_sigma = kHold;
    } else {
      continue;  // the rig file has no such figure
    }
    any = true;
  }
  return any;
}

CameraImuCalibration Failed(CameraImuCalibration result, const char* reason) {
  result.success = false;
  result.reason = reason;
  return result;
}

}  // namespace

CameraImuCalibration CalibrateCameraImu(const Trajectory& camera, const std::vector<ImuSample>& imu,
                                        const Rig& rig) {
  CameraImuCalibration result;
  std::vector<ImuSample> whole = LongestWhole(imu, kMaxImuGap);
  if (whole.size() < 2) return Failed(result, "there are no IMU samples without holes");
  const ImuTrack track(std::move(whole));
  Trajectory stamped = camera;  // in IMU time as the rig file has it; what is found comes on top
  for (StampedPose& s : stamped) s.t += rig.camera_time_offset;
  const Trajectory poses = Thin(stamped, track);
  if (poses.size() < kFewestPoses || ToSeconds(poses.back().t - poses.front().t) < kShortest) {
    return Failed(result,
                  "the camera was tracked for less than 3 s of the IMU's time: record 10 to 30 s of motion "
                  "that turns about two axes");
  }
  result.seconds = ToSeconds(poses.back().t - poses.front().t);
  const RateAlignment rates = AlignRates(stamped, track, kMaxOffset);
  result.turning = rates.spread;

  CameraImuPrior prior;
  prior.T_body_camera = rig.T_body_camera;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  prior.position_information = I / (kTranslationPrior * kTranslationPrior);
  prior.rotation_information = I / (kRotationPrior * kRotationPrior);

  CameraImuBatch batch(poses, &track, rig, kImuNoiseFactor, Start(rates, rig));
  constexpr const char* kDiverged = "the batch did not converge: do map, rig and log belong together?";
  if (!batch.Solve(prior, {}, true)) return Failed(result, kDiverged);
  result.n_rejected = batch.RemoveOutliers(batch.MeasureNoise(), kOutlier);
  if (batch.size() < kFewestPoses) return Failed(result, "too few poses of the camera fit the IMU");
  // Errors of the poses that wander slowly bend the chain instead of showing, unless it is stiff.
  if (!batch.Solve(prior, kStiff, false)) return Failed(result, kDiverged);
  result.noise = batch.MeasureNoise();
  if (result.noise.position > 0.05 || result.noise.rotation > 0.05) {
    return Failed(result, "the camera's poses and the IMU do not fit: do map, rig and log belong together?");
  }
  if (!batch.Solve(prior, result.noise, false)) return Failed(result, kDiverged);
  result.covariance = batch.covariance();
  result.unobservable = FindUnobservable(result.covariance);
  if (Hold(result.unobservable, &prior) && !batch.Solve(prior, result.noise, false))
    return Failed(result, kDiverged);
  result.n_poses = static_cast<int>(batch.size());
  result.values = batch.values();
  result.values.offset += rig.camera_time_offset;
  result.success = true;
  return result;
}

}  // namespace evit
