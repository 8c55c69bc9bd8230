#pragma once

#include <vector>

#include "common/calibration/camera_imu_calibration.h"

namespace evit {

/// How well the T_body_camera that a calibration gives is known, for its rig file: standard deviations by
/// axis. `covariance`: of position (m, body frame), then rotation (rad, camera frame), before unobservable
/// values are held. In an unobservable direction the rig file's figure was kept: it is known as `before` says
/// or, where that says nothing of rotation or translation, as the calibration does. At most what a rig file
/// may say (0.34 rad, 1 m).
ExtrinsicsSigma CalibratedSigma(const Matrix6d& covariance, const std::vector<Unobservable>& unobservable,
                                const ExtrinsicsSigma& before);

}  // namespace evit
