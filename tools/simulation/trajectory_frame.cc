#include "tools/simulation/trajectory_frame.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace evit::simulation {

namespace {

// y up -> z up: a quarter turn about x.
SE3 ZUpFromYUp() { return {ExpSO3(Eigen::Vector3d(1.5707963267948966, 0, 0)), Eigen::Vector3d::Zero()}; }

// How much the poses look like a camera held by hand: upright, level, 0.5 to 2.5 m over the floor. Each alone
// is not enough: on VECtor's files the wrong frame can be as upright, on others as level, as the right one.
double HandHeldScore(const Trajectory& poses, const SE3& left, const SE3& right) {
  double up = 0, roll = 0, height = 0;
  for (const StampedPose& pose : poses) {
    const SE3 T_map_camera = left * pose.pose * right;
    up -= (T_map_camera.q * Eigen::Vector3d::UnitY()).z();
    roll += std::abs((T_map_camera.q * Eigen::Vector3d::UnitX()).z());
    height += T_map_camera.p.z();
  }
  const auto n = static_cast<double>(poses.size());
  return (up - roll) / n - (height / n < 0.5 || height / n > 2.5 ? 1 : 0);
}

}  // namespace

std::string ConvertToBody(TrajectoryFrame frame, const Rig& rig, Trajectory* poses) {
  const double body = HandHeldScore(*poses, SE3(), rig.T_body_camera);
  const double marker = HandHeldScore(*poses, ZUpFromYUp(), rig.T_marker_body * rig.T_body_camera);
  std::ostringstream note;
  if (frame == TrajectoryFrame::kAuto) {
    frame = marker > body ? TrajectoryFrame::kMarkerYUp : TrajectoryFrame::kBody;
    note << std::fixed << std::setprecision(2)
         << "frame detected (upright, level, hand-held height: marker-yup " << marker << ", body " << body
         << "); ";
  }
  const bool is_marker = frame == TrajectoryFrame::kMarkerYUp;
  note << "poses read as " << (is_marker ? "marker-yup" : "body");
  if (is_marker) {
    for (StampedPose& pose : *poses) pose.pose = ZUpFromYUp() * pose.pose * rig.T_marker_body;
  }
  return note.str();
}

}  // namespace evit::simulation
