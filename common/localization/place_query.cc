#include "common/localization/place_query.h"

#include <cmath>

namespace evit {

bool PlacePrior::Allows(const SE3& T_map_body, double slack, double slack_yaw) const {
  const Eigen::Vector3d& p = T_map_body.p;
  if (near && (p - near->position).norm() > near->radius + slack) return false;
  if (height && (p.z() < height->low - slack || p.z() > height->high + slack)) return false;
  if (!heading) return true;
  const Eigen::Vector3d x = T_map_body.q * Eigen::Vector3d::UnitX();
  return std::abs(std::remainder(std::atan2(x.y(), x.x()) - heading->yaw, 2 * EIGEN_PI)) <=
         heading->tolerance + slack_yaw;
}

}  // namespace evit
