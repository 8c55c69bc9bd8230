#include "common/geometry/pose_text.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace evit {

SE3 ParsePose(const std::string& option, const std::string& text) {
  double v[7];
  char rest = 0;
  const int n = std::sscanf(text.c_str(), " %lf %lf %lf %lf %lf %lf %lf %c", v, v + 1, v + 2, v + 3, v + 4,
                            v + 5, v + 6, &rest);
  const std::string error = option + " \"" + text +
                            "\": expected seven numbers, x y z (m) and a unit "
                            "quaternion qx qy qz qw";
  if (n != 7) throw std::runtime_error(error);
  for (const double number : v) {
    if (!std::isfinite(number)) throw std::runtime_error(error + "; not all are finite");
  }
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1) >= 1e-2)
    throw std::runtime_error(error + "; the quaternion's norm is " + std::to_string(q.norm()));
  return {q.normalized(), {v[0], v[1], v[2]}};
}

}  // namespace evit
