#include "common/tracking/event_lag.h"

namespace evit {
namespace {

constexpr double kSlow =
    5;  // pixels/s: well below it the direction of motion means nothing, and neither does a lag

}  // namespace

std::vector<Eigen::Vector3f> CompensateEventLag(const AlignmentSettings& settings,
                                                std::vector<Eigen::Vector3f> points, const SE3& T_map_body,
                                                const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate,
                                                double lag_px) {
  if (lag_px == 0) return points;
  const Eigen::Matrix3d R_wb = T_map_body.R(), R_bw = R_wb.transpose(), R_cb = settings.T_camera_body.R();
  const Eigen::Vector3d v_body = R_bw * velocity;
  for (Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p_body = R_bw * (point.cast<double>() - T_map_body.p);
    const Eigen::Vector3d flow = -v_body - rate.cross(p_body);  // m/s, of a fixed point seen from the body
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!settings.camera().Project(settings.T_camera_body * p_body, &pixel, &jacobian)) continue;
    const double delay = lag_px / ((jacobian * (R_cb * flow)).norm() + kSlow);  // s
    point -= (R_wb * (delay * flow)).cast<float>();
  }
  return points;
}

}  // namespace evit
