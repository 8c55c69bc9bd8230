#include "common/calibration/camera_imu_calibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/calibration/rate_alignment.h"

namespace evit {
namespace {

constexpr Utime kMaxOffset = 100'000, kMaxImuGap = 50'000;  // us
constexpr Utime kShortestStep = 10'000;                     // us between poses: two samples of a 200 Hz IMU
constexpr std::size_t kMostPoses = 3000, kFewestPoses = 100;
constexpr double kShortest = 3;             // s
constexpr double kImuNoiseFactor = 2;       // as in tracking: integration error and vibration
constexpr double kRegistration = 0.5;       // px, as OverlapCalibrationOptions::registration_px
constexpr double kAlike = 0.7, kDepth = 1;  // s, m: of the scene
constexpr double kMostLag = 0.1;            // s
constexpr double kHold = 1e6;               // times the prior's information
constexpr double kOutlier = 5;              // sigmas of one axis
// Standard deviations above which a value counts as not observable.
constexpr double kMaxGyroBias = 0.01, kMaxAccelBias = 0.05, kMaxTilt = 0.005;  // rad/s, m/s^2, rad
constexpr PoseNoise kStiff{0.03, 0.01, 1, 1};  // poses that count so little that the IMU shapes the motion

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
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Zero();
  tilt.topLeftCorner<2, 2>() = P.block<2, 2>(7, 7);
  FindUnobservable(tilt, kMaxTilt, Value::kTilt, &out);
  FindUnobservable(P.block<3, 3>(9, 9), kMaxGyroBias, Value::kGyroBias, &out);
  FindUnobservable(P.block<3, 3>(12, 12), kMaxAccelBias, Value::kAccelBias, &out);
  return out;
}

RigVector Moved(const SE3& from, const CameraImuValues& to) {
  RigVector moved;
  moved << to.T_body_camera.p - from.p, LogSO3(from.q.conjugate() * to.T_body_camera.q), ToSeconds(to.offset);
  return moved;
}

// Covariance of all values where the rig's are not those of the solution, whose is P, but known to `rig`. The
// others lean on the extrinsics.
CameraImuCovariance WithRig(const CameraImuCovariance& P, const RigMatrix& rig) {
  const Eigen::Matrix<double, 8, 6> lean =
      P.topLeftCorner<6, 6>().ldlt().solve(P.topRightCorner<6, 8>()).transpose();
  Eigen::Matrix<double, 15, 7> by_rig = Eigen::Matrix<double, 15, 7>::Zero();
  by_rig << RigMatrix::Identity(), lean, Eigen::Matrix<double, 8, 1>::Zero();
  CameraImuCovariance out = by_rig * rig * by_rig.transpose();
  out.bottomRightCorner<8, 8>() += P.bottomRightCorner<8, 8>() - lean * P.topRightCorner<6, 8>();
  return out;
}

// Seconds by which poses lag behind, or run ahead, where they stand off by kRegistration along the motion.
double LagSigma(const RateAlignment& rates, const Camera& camera) {
  return std::min(kMostLag, kRegistration / camera.fx / std::max(rates.spread.norm(), 1e-3));
}

// Errors of the poses that are alike over kAlike hardly show in a short recording: the chain bends to them.
// Of half a pixel there are always some.
PoseNoise AtLeast(PoseNoise noise, double step, const Camera& camera) {
  const double rotation = kRegistration / camera.fx, position = rotation * kDepth,
               n = std::max(1.0, kAlike / step);
  noise.position_correlation =
      std::max(noise.position_correlation, n * std::pow(position / noise.position, 2));
  noise.rotation_correlation =
      std::max(noise.rotation_correlation, n * std::pow(rotation / noise.rotation, 2));
  return noise;
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
  result.prior_sigma = RigPriorSigma(rig);
  const double lag_sigma = LagSigma(rates, rig.camera);
  RigVector sigma = result.prior_sigma;
  sigma[6] = std::hypot(sigma[6], lag_sigma);
  prior.information = sigma.array().square().inverse().matrix().asDiagonal();

  CameraImuBatch batch(poses, &track, rig, kImuNoiseFactor, Start(rates, rig));
  constexpr const char* kDiverged = "the batch did not converge: do map, rig and log belong together?";
  if (!batch.Solve(prior, {}, true)) return Failed(result, kDiverged);
  result.n_rejected = batch.RemoveOutliers(batch.MeasureNoise(), kOutlier);
  if (batch.size() < kFewestPoses) return Failed(result, "too few poses of the camera fit the IMU");
  // Errors of the poses that wander slowly bend the chain instead of showing, unless it is stiff.
  if (!batch.Solve(prior, kStiff, false)) return Failed(result, kDiverged);
  result.noise =
      AtLeast(batch.MeasureNoise(), result.seconds / static_cast<double>(batch.size()), rig.camera);
  if (result.noise.position > 0.05 || result.noise.rotation > 0.05) {
    return Failed(result, "the camera's poses and the IMU do not fit: do map, rig and log belong together?");
  }
  if (!batch.Solve(prior, result.noise, false)) return Failed(result, kDiverged);
  result.unobservable = FindUnobservable(batch.covariance());
  result.rig = UpdateRig(result.prior_sigma, lag_sigma, Moved(rig.T_body_camera, batch.values()),
                         batch.covariance().topLeftCorner<7, 7>());
  result.covariance = WithRig(batch.covariance(), result.rig.covariance);
  // Tilt and biases lean on the extrinsics: once more, with those that are written.
  prior.T_body_camera.p += result.rig.change.head<3>();
  prior.T_body_camera.q = prior.T_body_camera.q * ExpSO3(result.rig.change.segment<3>(3));
  prior.information.topLeftCorner<6, 6>() *= kHold;
  if (!batch.Solve(prior, result.noise, false)) return Failed(result, kDiverged);
  result.n_poses = static_cast<int>(batch.size());
  result.values = batch.values();
  result.values.T_body_camera = prior.T_body_camera;
  result.values.offset = rig.camera_time_offset + std::llround(1e6 * result.rig.change[6]);
  result.success = true;
  return result;
}

}  // namespace evit
