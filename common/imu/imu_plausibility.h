#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// What seems wrong with the units of IMU samples, as a sentence for a person with the measured value; empty
/// where nothing does, or where there are too few to tell (0.2 s, 20 samples). Looks at the mean specific
/// force over half a second, which is gravity but for a body in free flight, and at whether its direction
/// turns as the gyro says. Tells: accelerometer in g or mg, gravity taken off, gyro in deg/s, both columns
/// swapped.
std::string ImuComplaint(const std::vector<ImuSample>& samples);

/// What seems wrong with the direction of gravity at the start: the mean specific force of `samples` (the
/// first half second) must point up in the map, where the body's orientation is `q_map_body`. Tells a turned
/// sign, a map whose z axis points down, a start pose of another frame. Empty where nothing seems wrong.
std::string GravityComplaint(const std::vector<ImuSample>& samples, const Eigen::Quaterniond& q_map_body);

}  // namespace evit
