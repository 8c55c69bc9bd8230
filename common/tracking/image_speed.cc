#include "common/tracking/image_speed.h"

#include <algorithm>

namespace evit {

double MedianImageSpeed(const AlignmentSettings& settings, const AlignmentPoints& points,
                        const SE3& T_map_body, const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate) {
  constexpr std::size_t kEnough = 200;  // points: a median needs no more
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kEnough);
  const Eigen::Matrix3d R_bw = T_map_body.R().transpose(), R_cb = settings.T_camera_body.R();
  const Eigen::Vector3d v_body = R_bw * velocity;
  std::vector<double> speeds;
  for (std::size_t k = 0; k < points.size(); k += stride) {
    const Eigen::Vector3d p_body = R_bw * (points.At(k) - T_map_body.p);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!settings.camera().Project(settings.T_camera_body * p_body, &pixel, &jacobian) ||
        !settings.camera().Contains(pixel)) {
      continue;
    }
    const Eigen::Vector3d flow = -v_body - rate.cross(p_body);  // of a fixed point, seen from the body
    speeds.push_back((jacobian * (R_cb * flow)).norm());
  }
  if (speeds.empty()) return 0;
  auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  return *middle;
}

}  // namespace evit
