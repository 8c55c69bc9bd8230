#include "tools/formats/export/export_results.h"

#include <iomanip>

#include "common/files/whole_file.h"
#include "tools/formats/export/mcap_writer.h"

namespace evit::formats {
namespace {

void WriteKitti(std::ostream& out, const Trajectory& trajectory) {
  for (const StampedPose& s : trajectory) {
    const Eigen::Matrix3d R = s.pose.q.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column)
        out << (row + column > 0 ? " " : "") << (column < 3 ? R(row, column) : s.pose.p[row]);
    }
    out << '\n';
  }
}

void WriteEuroc(std::ostream& out, const Trajectory& trajectory) {
  out << "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  for (const StampedPose& s : trajectory) {
    out << s.t << "000";
    for (const double v :
         {s.pose.p.x(), s.pose.p.y(), s.pose.p.z(), s.pose.q.w(), s.pose.q.x(), s.pose.q.y(), s.pose.q.z()})
      out << ',' << v;
    out << '\n';
  }
}

}  // namespace

Trajectory CameraTrajectory(const Trajectory& body, const Rig& rig) {
  Trajectory camera;
  camera.reserve(body.size());
  for (const StampedPose& s : body)
    camera.push_back({s.t - rig.camera_time_offset, s.pose * rig.T_body_camera});
  return camera;
}

void WriteTrajectory(const std::string& path, TrajectoryFormat format, const Trajectory& trajectory) {
  if (format == TrajectoryFormat::kTum) return WriteTum(path, trajectory);
  WholeFile file(path);
  file.stream() << std::setprecision(12);
  switch (format) {
    case TrajectoryFormat::kKitti:
      WriteKitti(file.stream(), trajectory);
      break;
    case TrajectoryFormat::kEuroc:
      WriteEuroc(file.stream(), trajectory);
      break;
    default:
      WritePosesMcap(file.stream(), trajectory);
  }
  file.Commit();
}

}  // namespace evit::formats
