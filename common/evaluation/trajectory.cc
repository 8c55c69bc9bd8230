#include "common/evaluation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "common/files/decimal_time.h"
#include "common/files/table_reader.h"
#include "common/files/table_sample.h"
#include "common/files/whole_file.h"
#include "common/time/time_order.h"

namespace evit {

namespace {

constexpr char kLayout[] = "t x y z qx qy qz qw";
constexpr double kSlowest = 5;  // s between poses, for telling the unit of the stamps

struct Row {
  Utime t;
  SE3 pose;
  std::int64_t line;
};

std::vector<Row> ReadRows(const std::string& path) {
  const TimeUnit unit = UnitOfStamps(SampleTable(path, kLayout), 0, kSlowest);
  TableReader table(path, kLayout);
  std::vector<Row> rows;
  while (table.Next()) {
    Row row;
    if (!table.Time(&row.t, unit)) table.Fail("the time is not finite");
    double v[7];
    for (double& x : v) x = table.Finite();
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (std::abs(q.norm() - 1) > 1e-2) table.Fail("the quaternion qx qy qz qw is not of length 1");
    row.pose = {q.normalized(), {v[0], v[1], v[2]}};
    row.line = table.line();
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string TumSkipped::Text(const std::string& path) const {
  if (rows == 0) return "";
  return path + ": " + std::to_string(rows) + (rows == 1 ? " row" : " rows") +
         " skipped, the first in line " + std::to_string(first_line) +
         ": the time does not increase, or lies far ahead of those that follow";
}

Trajectory ReadTum(const std::string& path, TumSkipped* skipped) {
  const std::vector<Row> rows = ReadRows(path);
  if (rows.empty()) throw std::runtime_error(path + ": contains no pose");
  TimeOrderOptions in_order;
  in_order.strict = true;
  in_order.window = 0;  // a row out of order has no place
  TimeOrderCounts counts;
  const std::vector<Row> kept = InTimeOrder(rows, in_order, &counts);
  TumSkipped out;
  out.rows = static_cast<std::int64_t>(rows.size() - kept.size());
  Trajectory trajectory;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (out.first_line == 0 && out.rows > 0 && kept[k].line != rows[k].line) out.first_line = rows[k].line;
    trajectory.push_back({kept[k].t, kept[k].pose});
  }
  if (out.rows > 0 && out.first_line == 0) out.first_line = rows[kept.size()].line;
  const bool many = out.rows > 1 && 20 * out.rows > static_cast<std::int64_t>(rows.size());
  if (out.rows > 0 && (skipped == nullptr || many)) {
    throw std::runtime_error(path + ":" + std::to_string(out.first_line) + ": the time does not increase" +
                             (many
                                  ? ", nor in " + std::to_string(out.rows - 1) + " more of " +
                                        std::to_string(rows.size()) + " rows; sort the file by time (sort -g)"
                                  : ""));
  }
  if (skipped != nullptr) *skipped = out;
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
