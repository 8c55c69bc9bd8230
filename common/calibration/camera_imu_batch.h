#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/calibration/imu_track.h"
#include "common/calibration/pose_noise.h"
#include "common/calibration/rig_prior.h"
#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"
#include "common/imu/preintegration.h"
#include "common/tracking/state.h"

namespace ceres {
class LossFunction;
class Problem;
}  // namespace ceres

namespace evit {

/// What is calibrated.
struct CameraImuValues {
  SE3 T_body_camera;
  Utime offset = 0;                                // us to add to the camera's stamps to get the IMU's
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  // rad: T_map_upright is Exp(tilt x, tilt y, 0)
  ImuBias bias;                                    // in the middle of the recording
};

/// Their covariance: T_body_camera (position m in the body frame, rotation rad in the camera frame: a right
/// perturbation), offset (s), tilt (rad), gyro bias (rad/s), accelerometer bias (m/s^2).
using CameraImuCovariance = Eigen::Matrix<double, 15, 15>;

/// What is known before: Gaussians around the rig file's figures.
struct CameraImuPrior {
  SE3 T_body_camera;
  Utime offset = 0;                               // us
  RigMatrix information = RigMatrix::Identity();  // of both: m, rad, s
  double tilt_sigma = 0.2;                        // rad
  double gyro_bias_sigma = 0.1;                   // rad/s
  double accel_bias_sigma = 0.1;                  // m/s^2: a sensor calibrated once
};

/// Least squares over a recording: a chain of body states at the instants of the camera's poses, joined by
/// pre-integrated IMU terms, each with its camera pose measured in the map. Continuous in the offset: states
/// stand at stamp + offset, and each Solve() moves them by what it found.
class CameraImuBatch {
 public:
  /// `camera`: T_map_camera, some 10 ms apart. `imu` must outlive this and cover all stamps moved by any
  /// offset that is tried. `noise_factor` multiplies the calibrated densities.
  CameraImuBatch(Trajectory camera, const ImuTrack* imu, const Rig& rig, double noise_factor,
                 const CameraImuValues& start);

  /// One solution; where `robust`, poses far off count little (Cauchy). False where it diverged. Repeats
  /// itself until the offset stands still.
  bool Solve(const CameraImuPrior& prior, const PoseNoise& noise, bool robust);

  /// How noisy the poses are, from their residuals after a solution.
  PoseNoise MeasureNoise() const;
  /// Removes poses that err by more than `sigmas` of it; returns how many.
  int RemoveOutliers(const PoseNoise& noise, double sigmas);

  const CameraImuValues& values() const { return values_; }
  /// Of the last solution.
  const CameraImuCovariance& covariance() const { return covariance_; }
  std::size_t size() const { return camera_.size(); }

 private:
  // Of a solution, beside the states.
  struct Unknowns {
    std::array<double, 7> extrinsic;  // T_body_camera
    Eigen::Vector2d tilt;
    double late;  // s to add to the offset
  };
  // `moved`: the offset, us.
  bool SolveOnce(const CameraImuPrior& prior, const PoseNoise& noise, bool robust, Utime* moved);
  // The problem refers to `unknowns`, `terms` and the states.
  void AddMeasurements(const PoseNoise& noise, ceres::LossFunction* loss, Unknowns* unknowns,
                       std::vector<Preintegration>* terms, ceres::Problem* problem);
  void AddPriors(const CameraImuPrior& prior, Unknowns* unknowns, ceres::Problem* problem);
  bool ComputeCovariance(Unknowns* unknowns, ceres::Problem* problem);
  Eigen::Matrix<double, 6, 1> Residual(std::size_t k) const;
  void StartStates();

  Trajectory camera_;
  const ImuTrack* imu_;
  Rig rig_;
  double noise_factor_;
  CameraImuValues values_;
  CameraImuCovariance covariance_ = CameraImuCovariance::Zero();
  std::vector<StateBlocks> states_;
};

}  // namespace evit
