#pragma once

#include <memory>
#include <vector>

#include "common/tracking/imu_term.h"
#include "common/tracking/tracker_options.h"

namespace evit {

/// One high-rate frame of the bootstrapping phase, localised from its events alone.
struct BootstrapFrame {
  Utime t = 0;
  SE3 T_map_body;
  std::shared_ptr<Preintegration> imu;  // from the previous frame to this one; unused in the first
};

struct VisualInertialAlignment {
  bool success = false;
  std::string reason;             // for a person, where it failed
  std::vector<BodyState> states;  // one per frame
};

/// Loosely coupled visual-inertial alignment (paper Sec. III-C): velocities and biases from poses and IMU
/// terms, then the terms are integrated again with the new biases and everything is solved once more.
///
/// The paper holds the poses fixed. Event-only poses are some millimetres noisy, though, and over frames 10
/// ms apart that would be a velocity noise of decimetres per second; so each pose is a measurement here, with
/// `position_sigma` (m) and `rotation_sigma` (rad), of which the paper's rule is the limit of zero. A
/// Gaussian prior on the biases stands for what a calibrated sensor's biases can be: within a fraction of a
/// second they are hardly observable.
VisualInertialAlignment AlignVisualInertial(const std::vector<BootstrapFrame>& frames, double gravity,
                                            const BootstrapOptions& options, double imu_noise_factor,
                                            double position_sigma = 0.003, double rotation_sigma = 0.005);

}  // namespace evit
