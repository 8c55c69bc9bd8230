#pragma once

#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// Which way is up, as an IMU in motion feels it.
struct Upright {
  bool known = false;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // body frame, at the last sample
  double sigma = 0;                               // rad, about each of two axes
};

/// From the samples of the last seconds: specific forces, turned into the last sample's frame by the gyro.
/// They are gravity and the body's acceleration, which is the second derivative of a smooth motion. How
/// smooth and how strong it is, the samples say themselves: for each of some time scales and strengths, with
/// a Gaussian process of that kind as the motion, gravity follows by generalised least squares, and how
/// likely the samples are. The mean of all, by likelihood, is the vertical. Of half a second of a fast motion
/// to and fro the error is half that of a mean, of a slow one the same.
///
/// `sigma` is what this says of the error; on real and simulated hand-held motions the errors agree with it.
/// Not known: fewer than ten samples, less than 0.08 s, or a mean that is not gravity (a fall, a wrong unit).
Upright EstimateUpright(const std::vector<ImuSample>& samples, double gravity);

}  // namespace evit
