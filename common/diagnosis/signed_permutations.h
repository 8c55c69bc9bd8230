#pragma once

#include <Eigen/Core>
#include <vector>

namespace evit::diagnosis {

/// The 24 turns of axes onto axes, and their mirror images; the first is none.
std::vector<Eigen::Matrix3d> SignedPermutations();

}  // namespace evit::diagnosis
