#include "common/evaluation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "common/files/decimal_time.h"
#include "common/files/pose_columns.h"
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

// Rows that are not finite, or whose quaternion is zero, as of a tracker that saw its target no more, are
// left out and counted.
std::vector<Row> ReadRows(const std::string& path, TumSkipped* skipped) {
  const TableSample sample = SampleTable(path, kLayout);
  const PoseColumns columns = PoseColumnsOf(sample);
  if (HoldsMatrices(sample))
    throw std::runtime_error(path + ": holds matrices; expected rows of " + std::string(kLayout));
  const TimeUnit unit = UnitOfPoses(sample, columns, kSlowest);
  TableReader table(path, kLayout);
  std::vector<Row> rows;
  while (table.Next()) {
    const PoseRow row = ReadPoseRow(columns, unit, &table);
    const Eigen::Map<const Eigen::Vector3d> p(row.position.data());
    const Eigen::Map<const Eigen::Quaterniond> q(row.orientation.data());
    if (!row.timed || !p.allFinite() || !q.coeffs().allFinite() || q.coeffs().isZero(0)) {
      if (skipped->rows++ == 0) skipped->first_line = table.line();
      continue;
    }
    if (std::abs(q.norm() - 1) > 1e-2) table.Fail("the quaternion qx qy qz qw is not of length 1");
    rows.push_back({row.t, {q.normalized(), p}, table.line()});
  }
  return rows;
}

}  // namespace

std::string TumSkipped::Text(const std::string& path) const {
  if (rows == 0) return "";
  return path + ": " + std::to_string(rows) + (rows == 1 ? " row" : " rows") +
         " skipped, the first in line " + std::to_string(first_line) +
         ": a number is not finite, the quaternion is zero, or the time does not increase or lies far ahead "
         "of those that follow";
}

Trajectory ReadTum(const std::string& path, TumSkipped* skipped) {
  TumSkipped out;
  const std::vector<Row> rows = ReadRows(path, &out);
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(path + ":" + std::to_string(out.first_line) + ": " + what);
  };
  if (out.rows > 0 && skipped == nullptr)
    fail("expected finite numbers and a quaternion: \"" + std::string(kLayout) + "\"");
  if (rows.empty())
    throw std::runtime_error(out.rows > 0
                                 ? out.Text(path)
                                 : path + ": contains no pose; expected rows of t x y z qx qy qz qw (TUM)");
  TimeOrderOptions in_order;
  in_order.strict = true;
  in_order.window = 0;  // a row out of order has no place
  TimeOrderCounts counts;
  const std::vector<Row> kept = InTimeOrder(rows, in_order, &counts);
  if (const std::size_t n = rows.size() - kept.size(); n > 0) {
    std::size_t first = 0;
    while (first < kept.size() && kept[first].line == rows[first].line) ++first;
    out.first_line = out.rows == 0 ? rows[first].line : std::min(out.first_line, rows[first].line);
    out.rows += static_cast<std::int64_t>(n);
    const bool many = n > 1 && 20 * n > rows.size();
    if (skipped == nullptr || many) {
      fail("the time does not increase" +
           (many ? ", nor in " + std::to_string(n - 1) + " more of " + std::to_string(rows.size()) +
                       " rows; sort the file by time (sort -g)"
                 : ""));
    }
  }
  if (skipped != nullptr) *skipped = out;
  Trajectory trajectory;
  for (const Row& row : kept) trajectory.push_back({row.t, row.pose});
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
