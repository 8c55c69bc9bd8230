#pragma once

#include "common/evaluation/trajectory.h"

namespace evit::paper {

/// The instant of the strongest angular acceleration, at least `before` s after the begin and `after` s
/// before the end of a trajectory; its middle where it is shorter than that. Requires two poses.
Utime MostJerky(const Trajectory& trajectory, double before, double after);

}  // namespace evit::paper
