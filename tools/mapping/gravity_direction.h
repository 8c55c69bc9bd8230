#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"

namespace evit::mapping {

/// Where up is in the frame of a body's poses: the mean of what its accelerometer felt, turned into that
/// frame. Over some seconds the motion's own accelerations cancel; a bias of 0.05 m/s^2 tilts it by up to 0.3
/// degrees.
class GravityMean {
 public:
  /// `body`: of the IMU, in its clock; must outlive this.
  explicit GravityMean(const Trajectory& body) : body_(body) {}

  /// Samples without a pose are passed over.
  void Add(const ImuSample& sample);
  std::size_t n() const { return n_; }
  /// Unit; zero where nothing was added.
  Eigen::Vector3d up() const { return sum_.stableNormalized(); }
  /// Of up against z.
  double TiltDegrees() const;

 private:
  const Trajectory& body_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  std::size_t n_ = 0;
};

/// The least rotation that makes z point up: moves points of the poses' frame. `log`: LCM log with IMU.
/// Throws std::runtime_error naming the file: no IMU samples at the times of the poses.
SE3 UprightRotation(const std::string& log, const Trajectory& body, const std::string& body_path);

}  // namespace evit::mapping
