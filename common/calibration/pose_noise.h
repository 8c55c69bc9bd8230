#pragma once

#include <Eigen/Core>
#include <vector>

namespace evit {

/// Residuals of a camera's poses.
struct PoseNoise {
  double position = 0.005;          // m, per axis
  double rotation = 0.002;          // rad
  double position_correlation = 1;  // so many poses are worth one: errors of neighbours are alike
  double rotation_correlation = 1;
};

/// Robustly, from residuals in order of time: position (m), then rotation (rad).
PoseNoise MeasurePoseNoise(const std::vector<Eigen::Matrix<double, 6, 1>>& residuals);

}  // namespace evit
