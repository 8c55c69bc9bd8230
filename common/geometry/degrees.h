#pragma once

namespace evit {

/// Angles are radians inside; degrees are for people, in settings and reports.
inline constexpr double kDegreesPerRadian = 57.295779513082323;
inline constexpr double kRadiansPerDegree = 0.017453292519943295;

}  // namespace evit
