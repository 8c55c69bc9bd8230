#pragma once

#include <string>
#include <vector>

#include "common/calibration/camera_imu_batch.h"

namespace evit {

/// A value that the motion does not show: the rig file's figure was kept.
struct Unobservable {
  enum class Value { kTranslation, kRotation, kTimeOffset, kGyroBias, kAccelBias, kTilt };
  Value value = Value::kTranslation;
  /// The direction of which nothing is known: body frame (translation, biases), camera frame (rotation), map
  /// frame (tilt: axis to turn about); zero for the offset.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double sigma = 0;  // to which it would be known: m, rad, s, rad/s, m/s^2, rad
};

struct CameraImuCalibration {
  bool success = false;
  std::string reason;  // for a person, where it failed
  CameraImuValues values;
  /// Of the rig file's figures and the recording together. What was not learned is known as before.
  CameraImuCovariance covariance = CameraImuCovariance::Zero();
  RigVector prior_sigma = RigVector::Zero();          // of the rig file's figures
  RigUpdate rig;                                      // what the recording adds to them
  std::vector<Unobservable> unobservable;             // of what no rig file holds: biases, tilt
  PoseNoise noise;                                    // of the camera's poses
  int n_poses = 0;                                    // used
  int n_rejected = 0;                                 // far off
  double seconds = 0;                                 // of the recording
  Eigen::Vector3d turning = Eigen::Vector3d::Zero();  // rad/s, falling: spread of the rate by axis
};

/// Extrinsics and time offset of a camera and an IMU, the IMU's biases and the tilt of the map, from the
/// camera's poses in the map (which need neither) and the raw IMU samples. First the camera's rate is
/// aligned with the gyro's in closed form (rate_alignment.h), then everything is solved for at once
/// (camera_imu_batch.h): with the poses' noise and its correlation in time measured from the residuals, poses
/// far off left out. Half a pixel of the poses' error is taken to be alike over 0.7 s, and along the motion
/// all the time, where it looks like a time offset: in a few seconds residuals do not show such errors, and
/// on VECtor's clips sigmas without them are too small by two to three. `rig` is a prior (RigPriorSigma), and
/// only what is observable and significantly off moves (RigUpdate). Biases known to no better than 10 mrad/s
/// and 50 mm/s^2 and a tilt to 0.3 deg, which trade off where the body leans little, are named.
///
/// `camera`: T_map_camera in order of time, stamped by the sensor (no offset added). `rig`: the figures to
/// start from, noise densities and gravity. An IMU recording with holes over 50 ms is used up to them.
CameraImuCalibration CalibrateCameraImu(const Trajectory& camera, const std::vector<ImuSample>& imu,
                                        const Rig& rig);

}  // namespace evit
