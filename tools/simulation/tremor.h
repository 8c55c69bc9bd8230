#pragma once

#include <cstdint>

#include "common/evaluation/trajectory.h"
#include "tools/simulation/pose_spline.h"

namespace evit::simulation {

/// A hand's tremor: narrow-band shaking about `hz`, in translation and rotation of the body.
struct Tremor {
  double hz = 0;   // centre frequency; 0: none
  double mm = 0;   // amplitude of the translation, mm: its RMS is that of a sine of this amplitude
  double deg = 0;  // the same of the rotation, degrees
};

/// The motion with a tremor on it: T_map_body(t) * tremor(t), as a spline whose knots are close enough for
/// it. Each of the six axes is a sum of three sines within 15 % of hz, with seeded phases, frequencies and
/// shares. `knot_spacing`: s, of the motion without tremor.
PoseSpline AddTremor(const PoseSpline& motion, const Tremor& tremor, double knot_spacing, std::uint64_t seed);

}  // namespace evit::simulation
