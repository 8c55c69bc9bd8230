#pragma once

#include <string>
#include <vector>

#include "common/evaluation/covariance_file.h"
#include "common/evaluation/trajectory.h"

namespace evit {

/// Normalised estimation error squared, e' P^-1 e, over many poses (Bar-Shalom, Li, Kirubarajan, "Estimation
/// with Applications to Tracking and Navigation", 2001, Sec. 5.4). Of an honest covariance the mean is `dof`,
/// and 95 % lie below chi-square's bound; a mean of 4 dof means sigmas half as large as they should be.
struct Nees {
  int dof = 0;
  int n = 0;
  double mean = 0, median = 0;
  double share_in_95 = 0;  // 0..1: of the poses, below the 95 % bound of chi-square with `dof`

  double mean_per_dof() const { return dof > 0 ? mean / dof : 0; }
};

/// One pose against the truth. error: truth minus estimate as a tangent vector of the estimate, position (m,
/// map frame) and rotation (rad, body frame); sigma: standard deviations of the same, zero where none given.
struct PoseError {
  Utime t = 0;
  Eigen::Matrix<double, 6, 1> error, sigma;
};

struct Consistency {
  Nees position, orientation, pose;
  int without_covariance = 0;     // poses with truth but no (or no positive definite) covariance
  std::vector<PoseError> errors;  // of all poses with truth
};

/// Scores the covariances of an estimate, in the map frame as it is (no alignment). Pose and covariance
/// belong together where their stamps are equal.
Consistency ConsistencyOf(const Trajectory& truth, const Trajectory& estimate,
                          const Covariances& covariances);

/// One line, e.g. for stdout.
std::string ConsistencyText(const Consistency& consistency);

}  // namespace evit
