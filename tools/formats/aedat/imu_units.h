#pragma once

namespace evit::formats {

/// iniVation's files give accelerations in g and angular rates in degrees a second.
inline constexpr double kStandardGravity = 9.80665;  // m/s^2
inline constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180;

}  // namespace evit::formats
