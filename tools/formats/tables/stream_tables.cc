#include "tools/formats/tables/stream_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "common/files/pose_columns.h"
#include "common/files/table_reader.h"
#include "common/files/table_sample.h"
#include "common/text/words.h"

namespace evit::formats {
namespace {

constexpr double kSlowestImu = 0.1, kSlowestPose = 5;  // s between two rows
constexpr char kImuLayout[] = "t gx gy gz ax ay az (or ax ay az gx gy gz)";
constexpr char kPoseLayout[] = "t x y z qx qy qz qw";

bool NamesAny(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

// Names of the columns, where the head has one for each; "[rad s^-1]" belongs to the word before it.
std::vector<std::string> ColumnNames(const TableSample& sample) {
  std::vector<std::string> names;
  bool in_unit = false;
  for (const std::string& word : sample.head) {
    const bool opens = word.front() == '[' || word.front() == '(';
    if ((opens || in_unit) && !names.empty()) {
      names.back() += LowerCase(word);
    } else {
      names.push_back(LowerCase(word));
    }
    in_unit = (in_unit || opens) && word.back() != ']' && word.back() != ')';
  }
  if (sample.rows.empty() || names.size() < sample.rows.front().size()) names.clear();
  return names;
}

double MedianNorm(const TableSample& sample, std::size_t first) {
  std::vector<double> norms;
  for (const auto& row : sample.rows) {
    if (row.size() < first + 3) continue;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = std::atof(row[first + k].c_str());
      sum += value * value;
    }
    norms.push_back(std::sqrt(sum));
  }
  if (norms.empty()) return 0;
  std::nth_element(norms.begin(), norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2), norms.end());
  return norms[norms.size() / 2];
}

struct ImuColumns {
  bool gyro_first = true;
  double gyro_unit = 1, accel_unit = 1;
};

ImuColumns FindImuColumns(const TableSample& sample, const std::string& path) {
  ImuColumns columns;
  const std::vector<std::string> names = ColumnNames(sample);
  if (names.size() >= 7) {
    const auto is_gyro = [&](std::size_t k) {
      return NamesAny(names[k], {"gyr", "omega", "w_", "ang", "gx", "wx"});
    };
    const auto is_accel = [&](std::size_t k) { return NamesAny(names[k], {"acc", "a_", "lin", "ax"}); };
    const std::string all = names[1] + names[4];
    if (NamesAny(all, {"deg"})) columns.gyro_unit = 3.14159265358979323846 / 180;
    if (NamesAny(all, {"[g]", "(g)"})) columns.accel_unit = 9.80665;
    if (is_gyro(1) != is_gyro(4) || is_accel(1) != is_accel(4)) {
      columns.gyro_first = is_gyro(1) || is_accel(4);
      return columns;
    }
  }
  // At 1 g or 9.8 m/s^2, more or less: what moves by hand turns slower than that.
  const double a = MedianNorm(sample, 1), b = MedianNorm(sample, 4);
  const auto gravity = [](double norm) { return norm > 7 && norm < 13; };
  if (gravity(a) == gravity(b)) {
    throw std::runtime_error(path + ": which columns are accelerations cannot be told (medians " +
                             std::to_string(a) + " and " + std::to_string(b) +
                             ", expected one near 9.8 m/s^2); name them in the first line: " +
                             "timestamp gyro_x gyro_y gyro_z accel_x accel_y accel_z");
  }
  columns.gyro_first = gravity(b);
  return columns;
}

}  // namespace

std::vector<ImuSample> ReadImuTable(const std::string& path, DropCounts* dropped) {
  const TableSample sample = SampleTable(path, kImuLayout);
  if (sample.rows.empty() || sample.rows.front().size() < 7)
    throw std::runtime_error(path + ": is no IMU file; expected " + kImuLayout);
  const TimeUnit unit = UnitOfStamps(sample, 0, kSlowestImu);
  const ImuColumns columns = FindImuColumns(sample, path);
  TableReader rows(path, kImuLayout);
  std::vector<ImuSample> samples;
  while (rows.Next()) {
    ImuSample s;
    bool finite = rows.Time(&s.t, unit);
    for (Eigen::Vector3d* v :
         {columns.gyro_first ? &s.gyro : &s.accel, columns.gyro_first ? &s.accel : &s.gyro}) {
      for (int k = 0; k < 3; ++k) (*v)[k] = rows.Number();
    }
    finite = finite && s.gyro.allFinite() && s.accel.allFinite();
    s.gyro *= columns.gyro_unit;
    s.accel *= columns.accel_unit;
    AppendValid(s, finite, &samples, dropped);
  }
  return samples;
}

Trajectory ReadPoseTable(const std::string& path, DropCounts* dropped) {
  const TableSample sample = SampleTable(path, kPoseLayout);
  if (sample.rows.empty() || sample.rows.front().size() < 8)
    throw std::runtime_error(path + ": is no trajectory; expected " + kPoseLayout);
  const PoseColumns columns = PoseColumnsOf(sample);
  const TimeUnit unit = UnitOfStamps(sample, columns.time, kSlowestPose);
  TableReader rows(path, kPoseLayout);
  Trajectory poses;
  while (rows.Next()) {
    const PoseRow row = ReadPoseRow(columns, unit, &rows);
    AppendPose({row.t,
                {Eigen::Map<const Eigen::Quaterniond>(row.orientation.data()),
                 Eigen::Map<const Eigen::Vector3d>(row.position.data())}},
               row.timed, &poses, dropped);
  }
  return poses;
}

}  // namespace evit::formats
