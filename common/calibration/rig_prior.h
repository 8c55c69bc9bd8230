#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/geometry/rig.h"

namespace evit {

/// What a calibration changes of a rig: position of T_body_camera (m, body frame), its rotation (rad, camera
/// frame: a right perturbation), the camera's time offset (s).
using RigVector = Eigen::Matrix<double, 7, 1>;
using RigMatrix = Eigen::Matrix<double, 7, 7>;

/// How well a rig file is known beforehand: standard deviations as T_body_camera_sigma states them and, for
/// each axis of which it states none, and for the time offset, the defaults: 1 cm, 1 deg, 5 ms. (VECtor's
/// published rotations are 1.2 to 1.4 deg off: config/vector/rig.textproto.)
RigVector RigPriorSigma(const Rig& rig);

/// One of seven directions, uncorrelated both before and after a recording: the common eigenvectors of prior
/// and posterior covariance.
struct RigDirection {
  RigVector one_sigma = RigVector::Zero();  // as far as one standard deviation of the prior: m, rad, s
  double posterior_mean = 0;                // in those: how far off the rig file is
  double posterior_variance = 1;            // 1 where the data say nothing
  bool observable = false;                  // it is at most a quarter: the data at least halve the sigma
  bool moved = false;                       // by posterior_mean; else the rig file's figure is kept
  double variance = 1;  // mean square error afterwards: of a kept figure with posterior_mean

  /// The rig file has a better figure than before, or its own is known as well.
  bool learned() const;
};

/// What a recording adds to a rig file. A direction is moved where it is observable and the rig file is off
/// by two standard deviations of the posterior or more; so neither what a recording does not show, nor
/// chance, makes a rig file worse.
struct RigUpdate {
  RigVector change = RigVector::Zero();      // of the rig file's figures; none in a direction that is kept
  RigMatrix covariance = RigMatrix::Zero();  // afterwards; the prior's in what is not observable
  std::vector<RigDirection> directions;      // the best known last

  bool learned_any() const;
};

/// The posterior of a solution whose prior has a mean of zero and standard deviations `prior_sigma` but for
/// the offset: it is solved for together with a lag of the data, of zero mean and standard deviation
/// `lag_sigma` (s), which looks alike and is no matter of the rig. `found`, `covariance`: the solution and
/// its covariance, the last of their values being offset plus lag.
RigUpdate UpdateRig(const RigVector& prior_sigma, double lag_sigma, const RigVector& found,
                    const RigMatrix& covariance);

}  // namespace evit
