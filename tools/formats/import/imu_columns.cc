#include "tools/formats/import/imu_columns.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>
#include <stdexcept>

#include "common/geometry/degrees.h"
#include "common/imu/standard_gravity.h"
#include "common/text/words.h"

namespace evit::formats {
namespace {

constexpr double kSlowest = 0.2;  // s: IMUs read more often than this

bool IsAnyOf(const std::string& word, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return word == name; });
}

bool Begins(const std::string& word, std::initializer_list<const char*> heads) {
  return std::any_of(heads.begin(), heads.end(), [&](const char* head) { return word.rfind(head, 0) == 0; });
}

// The parts of "imu_angular_velocity_x", of "field.header.stamp.secs"; empty ones are left out.
std::vector<std::string> Parts(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : LowerCase(name)) {
    if (c != '_' && c != '.' && c != '/' && c != '-') {
      parts.back() += c;
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty() && parts.size() > 1) parts.pop_back();
  return parts;
}

int TimeNamed(const std::vector<std::string>& parts) {
  const std::string& last = parts.back();
  if (Begins(last, {"nsec", "nanosec"}) && parts.size() > 1 &&
      !IsAnyOf(parts[parts.size() - 2], {"t", "time", "timestamp"}))
    return ImuColumns::kNanoseconds;
  if (IsAnyOf(last, {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"})) return ImuColumns::kNanoseconds;
  if (IsAnyOf(last, {"sec", "secs", "seconds"}) || IsAnyOf(parts.front(), {"t", "ts"}) ||
      Begins(parts.front(), {"time", "stamp"}) || IsAnyOf(last, {"stamp", "timestamp", "time"}))
    return ImuColumns::kTime;
  return ImuColumns::kIgnored;
}

// A unit at the end of a name: "gyro_x_dps", "ax_g".
bool IsUnit(const std::string& part) {
  return IsAnyOf(part, {"g", "dps", "deg", "degs", "rad", "rads", "radps", "mps2", "ms2", "mss"});
}

int FieldNamed(const std::string& name) {
  std::vector<std::string> parts = Parts(name);
  if (parts.back().empty()) return ImuColumns::kIgnored;
  if (const int time = TimeNamed(parts); time != ImuColumns::kIgnored) return time;
  while (parts.size() > 1 && IsUnit(parts.back())) parts.pop_back();
  const char axis = parts.back().back();
  if (axis < 'x' || axis > 'z') return ImuColumns::kIgnored;
  parts.back().pop_back();
  if (parts.back().empty() && parts.size() > 1) parts.pop_back();
  while (parts.size() > 1 && Begins(parts.front(), {"imu", "field", "data", "msg"}))
    parts.erase(parts.begin());
  std::string vector = parts.front();
  if (Begins(vector, {"imu"})) vector.erase(0, 3);
  if (IsAnyOf(vector, {"w", "g", "r", "ang", "rot"}) ||
      Begins(vector, {"gyr", "omega", "angular", "rotation", "rate"}))
    return ImuColumns::kGyro + (axis - 'x');
  if (IsAnyOf(vector, {"a", "f", "lin"}) || Begins(vector, {"acc", "linear", "force", "specific"}))
    return ImuColumns::kAccel + (axis - 'x');
  return ImuColumns::kIgnored;
}

bool SaysDegrees(const ColumnName& name) {
  const std::string all = LowerCase(name.name + " " + name.unit);
  return all.find("deg") != std::string::npos || all.find("dps") != std::string::npos ||
         all.find("\xC2\xB0") != std::string::npos;
}

bool SaysGravities(const ColumnName& name) {
  return IsAnyOf(LowerCase(name.unit), {"[g]", "(g)"}) || Parts(name.name).back() == "g";
}

// By the names, where all are there.
bool ByHead(const TableSample& sample, ImuColumns* columns) {
  const std::size_t n = sample.rows.empty() ? 0 : sample.rows.front().size();
  std::vector<ColumnName> names = NamedColumns(sample.head);
  if (names.size() + 1 == n)
    names.insert(names.begin(), {"", ""});  // an index column without a name (pandas)
  if (names.size() > n || names.size() < 7) return false;
  std::set<int> found;
  for (const ColumnName& name : names) {
    int field = name.name.empty() ? int{ImuColumns::kIgnored} : FieldNamed(name.name);
    // The stamp of a message says more than the time at which it was recorded.
    if (field == ImuColumns::kTime && found.count(field) != 0 &&
        LowerCase(name.name).find("stamp") != std::string::npos)
      std::replace(columns->field.begin(), columns->field.end(), field, int{ImuColumns::kIgnored});
    else if (!found.insert(field).second)
      field = ImuColumns::kIgnored;
    columns->field.push_back(field);
    if (field >= ImuColumns::kGyro && field < ImuColumns::kAccel && SaysDegrees(name))
      columns->gyro_unit = kRadiansPerDegree;
    if (field >= ImuColumns::kAccel && field < ImuColumns::kIgnored && SaysGravities(name))
      columns->accel_unit = kStandardGravity;
  }
  found.erase(ImuColumns::kIgnored);
  found.erase(ImuColumns::kNanoseconds);
  if (found.size() == 7) return true;
  *columns = {};
  return false;
}

std::vector<double> Column(const TableSample& sample, std::size_t column) {
  std::vector<double> values;
  for (const auto& row : sample.rows) {
    double value = 0;
    if (column < row.size() && ParseNumber(row[column], &value)) values.push_back(value);
  }
  return values;
}

// Whole seconds in the first column and nanoseconds in the second: only together do they always increase.
bool SecondsAndNanoseconds(const TableSample& sample) {
  const std::vector<double> s = Column(sample, 0), ns = Column(sample, 1);
  if (s.size() < 10 || s.size() != ns.size()) return false;
  std::size_t same = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    if (s[k] != std::floor(s[k]) || ns[k] != std::floor(ns[k]) || ns[k] < 0 || ns[k] >= 1e9) return false;
    if (k == 0) continue;
    same += s[k] == s[k - 1] ? 1 : 0;
    if (s[k] < s[k - 1] || (s[k] == s[k - 1] && ns[k] <= ns[k - 1])) return false;
  }
  return 2 * same > s.size();
}

double MedianNorm(const TableSample& sample, std::size_t first) {
  std::vector<double> norms;
  for (const auto& row : sample.rows) {
    if (row.size() < first + 3) continue;
    double sum = 0, value = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (ParseNumber(row[first + k], &value)) sum += value * value;
    }
    norms.push_back(std::sqrt(sum));
  }
  if (norms.empty()) return 0;
  std::nth_element(norms.begin(), norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2), norms.end());
  return norms[norms.size() / 2];
}

// At 9.8 m/s^2, more or less: what moves by hand turns slower than that.
bool GyroFirst(const TableSample& sample, const std::string& path, std::size_t first) {
  const double a = MedianNorm(sample, first), b = MedianNorm(sample, first + 3);
  const auto gravity = [](double norm) { return norm > 7 && norm < 13; };
  if (gravity(a) == gravity(b)) {
    throw std::runtime_error(path + ": which columns are accelerations cannot be told (medians " +
                             std::to_string(a) + " and " + std::to_string(b) +
                             ", expected one near 9.8 m/s^2); name them in the first line: " +
                             "timestamp gyro_x gyro_y gyro_z accel_x accel_y accel_z");
  }
  return gravity(b);
}

// The next row; false where it is not finite.
bool ReadRow(const ImuColumns& columns, TableReader* rows, ImuSample* sample) {
  bool finite = true;
  Utime fraction = 0;
  for (const int field : columns.field) {
    if (field == ImuColumns::kTime) {
      finite = rows->Time(&sample->t, columns.unit) && finite;
    } else if (field == ImuColumns::kNanoseconds) {
      finite = rows->Time(&fraction, TimeUnit::kNanoseconds) && finite;
    } else if (field < ImuColumns::kAccel) {
      sample->gyro[field - ImuColumns::kGyro] = columns.gyro_unit * rows->Number();
    } else if (field < ImuColumns::kIgnored) {
      sample->accel[field - ImuColumns::kAccel] = columns.accel_unit * rows->Number();
    } else {
      rows->Word();
    }
  }
  sample->t += fraction;
  return finite && sample->accel.allFinite() && sample->gyro.allFinite();
}

// Names that do not say it all, above more columns than an IMU needs: which they are cannot be told from
// values.
void RequirePlainColumns(const TableSample& sample, const std::string& path) {
  constexpr std::size_t kNeeded = 7;
  const std::size_t n = sample.rows.empty() ? 0 : sample.rows.front().size();
  const std::vector<ColumnName> names = NamedColumns(sample.head);
  if (n <= kNeeded || names.size() != n) return;
  std::string unknown;
  for (const ColumnName& name : names) {
    if (FieldNamed(name.name) == ImuColumns::kIgnored) unknown += (unknown.empty() ? "" : ", ") + name.name;
  }
  throw std::runtime_error(
      path + ": the names of its columns do not tell time, gyro and accelerometer (not known: " + unknown +
      "); name them in the first line: timestamp gyro_x gyro_y gyro_z accel_x accel_y accel_z");
}

}  // namespace

ImuColumns FindImuColumns(const TableSample& sample, const std::string& path, ImuOrder usual) {
  ImuColumns columns;
  if (!ByHead(sample, &columns)) {
    RequirePlainColumns(sample, path);
    columns.field = {ImuColumns::kTime};
    if (SecondsAndNanoseconds(sample)) columns.field.push_back(ImuColumns::kNanoseconds);
    const std::size_t first = columns.field.size();
    const bool gyro_first =
        usual == ImuOrder::kByGravity ? GyroFirst(sample, path, first) : usual == ImuOrder::kGyroFirst;
    for (const int begin : {gyro_first ? ImuColumns::kGyro : ImuColumns::kAccel,
                            gyro_first ? ImuColumns::kAccel : ImuColumns::kGyro}) {
      for (int axis = 0; axis < 3; ++axis) columns.field.push_back(begin + axis);
    }
  }
  const auto has = [&](int field) { return std::find(columns.field.begin(), columns.field.end(), field); };
  if (has(ImuColumns::kNanoseconds) == columns.field.end())
    columns.unit = UnitOfStamps(
        sample, static_cast<std::size_t>(has(ImuColumns::kTime) - columns.field.begin()), kSlowest);
  return columns;
}

std::vector<ImuSample> ReadImuRows(const std::string& path, const std::string& layout, ImuOrder usual,
                                   DropCounts* dropped) {
  const TableSample sample = SampleTable(path, layout);
  const std::size_t words = sample.rows.empty() ? 0 : sample.rows.front().size();
  std::vector<ImuSample> samples;
  if (words < 7 && usual == ImuOrder::kByGravity)
    throw std::runtime_error(path + ": is no IMU file; expected " + layout);
  if (sample.rows.empty()) return samples;
  const ImuColumns columns = FindImuColumns(sample, path, usual);
  TableReader rows(path, layout);
  while (rows.Next()) {
    if (rows.CutOff(words)) {
      dropped->cut_off = true;
      break;
    }
    ImuSample s;
    const bool finite = ReadRow(columns, &rows, &s);
    AppendValid(s, finite, &samples, dropped);
  }
  return samples;
}

}  // namespace evit::formats
