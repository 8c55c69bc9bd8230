#pragma once

#include <limits>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit {

/// Noise of an IMU in continuous time (Kalibr's convention). Per sample: density / sqrt(dt).
struct ImuNoise {
  double gyro_density = 0;                                       // rad/s/sqrt(Hz)
  double accel_density = 0;                                      // m/s^2/sqrt(Hz)
  double gyro_random_walk = 0;                                   // rad/s^2/sqrt(Hz)
  double accel_random_walk = 0;                                  // m/s^3/sqrt(Hz)
  double gyro_range = std::numeric_limits<double>::infinity();   // rad/s: largest reading of an axis
  double accel_range = std::numeric_limits<double>::infinity();  // m/s^2
};

/// How well T_body_camera is known: standard deviations, axis by axis. Zero: exactly.
struct ExtrinsicsSigma {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     // rad, about the camera's axes
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m, along the body's axes
};

/// Calibration of one event camera with one IMU. The body frame is the IMU's.
struct Rig {
  Camera camera;
  SE3 T_body_camera;
  ExtrinsicsSigma T_body_camera_sigma;
  SE3 T_marker_body;  // body in the frame of the motion-capture marker body; identity where there is none
  ImuNoise imu_noise;
  double imu_rate_hz = 0;
  double gravity = 9.81;         // m/s^2; points along -z of the map frame
  Utime camera_time_offset = 0;  // us to add to event stamps to get IMU time
};

/// A further camera of a rig, such as a regular one beside the event camera.
struct MountedCamera {
  Camera camera;
  SE3 T_body_camera, T_marker_body;  // as in Rig; identity where not known
  bool mounted = false;              // T_body_camera is known
  Utime time_offset = 0;             // us to add to its stamps to get IMU time
};

}  // namespace evit
