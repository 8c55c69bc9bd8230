#include "common/evaluation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "common/evaluation/decimal_time.h"

namespace evit {

Trajectory ReadTum(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read; a TUM file (t x y z qx qy qz qw) is wanted");
  Trajectory trajectory;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(
          std::string(path).append(":").append(std::to_string(number)).append(": ").append(what));
    };
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string stamp;
    if (!(words >> stamp) || stamp[0] == '#') continue;
    StampedPose row;
    if (!ParseDecimalSeconds(stamp, &row.t)) fail("\"" + stamp + "\" is not a time in decimal seconds");
    double v[7];
    for (double& x : v) {
      if (!(words >> x)) fail("eight numbers are wanted: t x y z qx qy qz qw");
      if (!std::isfinite(x)) fail("a value is not finite");
    }
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (std::abs(q.norm() - 1) > 1e-2) fail("the quaternion qx qy qz qw is not of length 1");
    if (!trajectory.empty() && row.t <= trajectory.back().t) fail("the time does not increase");
    row.pose = {q.normalized(), {v[0], v[1], v[2]}};
    trajectory.push_back(row);
  }
  if (trajectory.empty()) throw std::runtime_error(path + ": holds no pose");
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
  const std::string part = path + ".part";
  std::ofstream file(part);
  file << "# timestamp[s] tx ty tz[m] qx qy qz qw\n";
  for (const StampedPose& s : trajectory) file << TumLine(s) << '\n';
  file.close();
  if (!file || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw std::runtime_error(path +
                             ": cannot be written; check that the folder exists, is writable and has room");
  }
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
