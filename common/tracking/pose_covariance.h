#pragma once

#include "common/tracking/state.h"

namespace evit {

// All are 6x6: position (m, map frame), then rotation (rad, right perturbation, body frame).

/// Covariance of the pose of a state whose inverse covariance is `information`.
Matrix6d PoseCovariance(const Matrix15d& information);

/// Covariance of the pose that no number of keyframes lowers: what the map and the edges do wrong is the same
/// in all of them. `share` of what one keyframe's alignment alone leaves open (`alignment`: its information),
/// at most some centimetres, and a shift of the whole map (m, per axis).
Matrix6d CommonCovariance(const Matrix6d& alignment, double share, double map_sigma);

/// What it does to the pose that events come late by an amount which nobody has measured (pixels' latency,
/// clocks set by hand): the body has moved on by then. `velocity`: m/s, map frame; `rate`: rad/s, body frame;
/// `sigma`: s.
Matrix6d StampCovariance(const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate, double sigma);

}  // namespace evit
