#pragma once

namespace evit {

/// What accelerometers that read in g call one g, m/s^2.
inline constexpr double kStandardGravity = 9.80665;

}  // namespace evit
