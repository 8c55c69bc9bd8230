#pragma once

#include <optional>
#include <vector>

#include "common/imu/imu_sample.h"
#include "common/localization/followed_places.h"

namespace evit {

/// How poses in a map agree with what the accelerometer felt between them.
struct MotionFit {
  double scale = 1;                  // metres of the map for one of the accelerometer
  double scale_sigma = 0;            // of it: large where the motion has hardly any acceleration
  double misfit = 0;                 // m: rms distance of the poses from the motion that fits them best
  std::vector<std::size_t> fitting;  // steps that it is made from: all but single poses that went astray

  /// Whether that cannot be chance.
  bool Disagrees() const;
};

/// Least squares: start, velocity, a constant acceleration (bias and tilt, within what a calibrated sensor
/// has) and one factor for all that the IMU says of the motion. A map in wrong units, or one from pictures
/// whose scale was never measured, explains every view of its events, and fits rotations; only this tells.
///
/// Single poses lie centimetres beside the others, where a view says little about some direction. As no body
/// jumps there and back within 50 ms, up to a quarter of the poses is left out, the worst first.
///
/// `samples`: from the first step to the last, their stamps among them. None: fewer than six steps.
std::optional<MotionFit> FitMotion(const std::vector<FollowedPlace::Step>& steps,
                                   const std::vector<ImuSample>& samples, double gravity);

}  // namespace evit
