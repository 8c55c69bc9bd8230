#include "common/diagnosis/signed_permutations.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace evit::diagnosis {

std::vector<Eigen::Matrix3d> SignedPermutations() {
  std::vector<Eigen::Matrix3d> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 3; ++k) m(k, order[static_cast<std::size_t>(k)]) = (signs >> k & 1) != 0 ? -1 : 1;
      all.push_back(m);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

}  // namespace evit::diagnosis
