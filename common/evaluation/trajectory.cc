#include "common/evaluation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "common/files/decimal_time.h"
#include "common/files/table_reader.h"
#include "common/files/whole_file.h"

namespace evit {

Trajectory ReadTum(const std::string& path) {
  TableReader rows(path, "t x y z qx qy qz qw");
  Trajectory trajectory;
  while (rows.Next()) {
    StampedPose row;
    if (!rows.Time(&row.t)) rows.Fail("the time is not finite");
    double v[7];
    for (double& x : v) x = rows.Finite();
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (std::abs(q.norm() - 1) > 1e-2) rows.Fail("the quaternion qx qy qz qw is not of length 1");
    if (!trajectory.empty() && row.t <= trajectory.back().t) rows.Fail("the time does not increase");
    row.pose = {q.normalized(), {v[0], v[1], v[2]}};
    trajectory.push_back(row);
  }
  if (trajectory.empty()) throw std::runtime_error(path + ": contains no pose");
  return trajectory;
}

std::string TumLine(const StampedPose& s) {
  char text[256];
  const auto& p = s.pose.p;
  const auto& q = s.pose.q;
  std::snprintf(text, sizeof text, "%s %.9g %.9g %.9g %.9g %.9g %.9g %.9g", DecimalSeconds(s.t).c_str(),
                p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  return text;
}

void WriteTum(const std::string& path, const Trajectory& trajectory) {
  WholeFile file(path);
  file.stream() << "# timestamp[s] tx ty tz[m] qx qy qz qw\n";
  for (const StampedPose& s : trajectory) file.stream() << TumLine(s) << '\n';
  file.Commit();
}

bool PoseAt(const Trajectory& trajectory, Utime t, SE3* pose, Utime max_gap) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), t,
                                      [](const StampedPose& s, Utime time) { return s.t < time; });
  if (after == trajectory.end()) return false;
  if (after->t == t) {
    *pose = after->pose;
    return true;
  }
  if (after == trajectory.begin()) return false;
  const auto before = after - 1;
  if (after->t - before->t > max_gap) return false;
  *pose = Interpolate(before->pose, after->pose,
                      static_cast<double>(t - before->t) / static_cast<double>(after->t - before->t));
  return true;
}

}  // namespace evit
