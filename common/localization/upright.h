#pragma once

#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// Which way is up, as an IMU in motion feels it.
struct Upright {
  bool known = false;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // body frame, at the last sample
  double sigma = 0;                               // rad
};

/// From the samples of the last second or so: specific forces, turned into the last sample's frame by the
/// gyro, and averaged with weights that rise and fall smoothly (Hann). Of the acceleration of a body that
/// goes to and fro such a mean keeps the difference of two mean velocities, where a plain mean keeps that of
/// two momentary ones: of hand-held motion a third of the error.
///
/// `sigma` is what the readings themselves say: by how much the means of the window's halves differ.
/// Not known: fewer than ten samples, less than 0.1 s, or a mean that is not gravity (a fall, a wrong unit).
Upright EstimateUpright(const std::vector<ImuSample>& samples, double gravity);

}  // namespace evit
