#include "common/files/pose_columns.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "common/text/words.h"

namespace evit {
namespace {

constexpr std::size_t kNone = PoseColumns::kNone;

bool IsTime(const std::string& name) {
  for (const char* known : {"t", "ts", "time", "timestamp", "stamp"})
    if (name == known) return true;
  return EndsWith(name, "timestamp") || EndsWith(name, ".stamp");
}

// "secs" of "header.stamp.secs", and what is before it.
bool TakeEnd(const std::string& name, std::initializer_list<const char*> ends, std::string* before) {
  for (const char* end : ends) {
    if (name != end && !EndsWith(name, std::string(".") + end) && !EndsWith(name, std::string("_") + end))
      continue;
    *before = name.substr(0, name.size() - std::char_traits<char>::length(end));
    return true;
  }
  return false;
}

// Whole seconds and nanoseconds in two columns of one name.
void FindTwoPartTime(const std::vector<ColumnName>& names, PoseColumns* columns) {
  std::string before, of;
  for (std::size_t s = 0; s < names.size(); ++s) {
    if (!TakeEnd(LowerCase(names[s].name), {"sec", "secs", "seconds"}, &of)) continue;
    for (std::size_t ns = 0; ns < names.size(); ++ns) {
      if (!TakeEnd(LowerCase(names[ns].name), {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"},
                   &before) ||
          before != of)
        continue;
      columns->time = s;
      columns->nanoseconds = ns;
      return;
    }
    if (columns->time == kNone) columns->time = s;
  }
}

// What the column is a component of: "q_rs_w" of "q_rs", "tx" of "t", "pose.position.x" of "pose.position".
std::string VectorOf(std::string name) {
  name.pop_back();
  while (!name.empty() && (name.back() == '_' || name.back() == '.')) name.pop_back();
  return name;
}

bool IsAnyOf(const std::string& vector, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) {
    return vector == name || EndsWith(vector, std::string(".") + name) ||
           vector.rfind(std::string(name) + "_", 0) == 0;
  });
}

bool IsPosition(const std::string& vector) {
  return vector.empty() || IsAnyOf(vector, {"t", "p", "pos", "position", "trans", "translation"});
}

bool IsOrientation(const std::string& vector) {
  return IsAnyOf(vector, {"q", "quat", "quaternion", "rot", "rotation", "orientation"});
}

}  // namespace

PoseColumns PoseColumnsOf(const TableSample& sample) {
  const std::vector<ColumnName> names = NamedColumns(sample.head);
  if (sample.rows.empty() || names.size() != sample.rows.front().size()) return {};
  PoseColumns found{kNone, kNone, {kNone, kNone, kNone}, {kNone, kNone, kNone, kNone}};
  const auto take = [](std::size_t column, std::size_t* into) {
    if (*into == kNone) *into = column;
  };
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string name = LowerCase(names[k].name);
    if (name.empty()) continue;
    // The stamp of a message says more than the time at which it was recorded.
    if (EndsWith(name, "header.stamp")) found.time = k;
    if (IsTime(name)) take(k, &found.time);
    const std::size_t axis = std::string("xyzw").find(name.back());
    if (axis == std::string::npos) continue;
    const std::string vector = VectorOf(name);
    if (axis < 3 && IsPosition(vector)) take(k, &found.position[axis]);
    if (IsOrientation(vector)) take(k, &found.orientation[axis]);
  }
  FindTwoPartTime(names, &found);
  const auto none = [](const auto& columns) {
    return std::find(columns.begin(), columns.end(), kNone) != columns.end();
  };
  return found.time == kNone || none(found.position) || none(found.orientation) ? PoseColumns() : found;
}

TimeUnit UnitOfPoses(const TableSample& sample, const PoseColumns& columns, double slowest_s) {
  return columns.nanoseconds != kNone ? TimeUnit::kSeconds : UnitOfStamps(sample, columns.time, slowest_s);
}

bool HoldsMatrices(const TableSample& sample) {
  constexpr double kRounding = 1e-2;
  if (sample.rows.empty() || NamedColumns(sample.head).size() == sample.rows.front().size()) return false;
  const std::vector<std::string>& row = sample.rows.front();
  if (row.size() != 1 + 12 && row.size() != 1 + 16) return false;
  std::array<double, 12> m{};
  for (std::size_t k = 0; k < m.size(); ++k) {
    if (!ParseNumber(row[k + 1], &m[k])) return false;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      const double dot = m[4 * a] * m[4 * b] + m[4 * a + 1] * m[4 * b + 1] + m[4 * a + 2] * m[4 * b + 2];
      if (!(std::abs(dot - (a == b ? 1 : 0)) < kRounding)) return false;
    }
  }
  return true;
}

PoseRow ReadPoseRow(const PoseColumns& columns, TimeUnit unit, TableReader* table) {
  const std::size_t last =
      std::max({columns.time, columns.nanoseconds == kNone ? 0 : columns.nanoseconds,
                *std::max_element(columns.position.begin(), columns.position.end()),
                *std::max_element(columns.orientation.begin(), columns.orientation.end())});
  PoseRow row;
  Utime fraction = 0;
  bool whole = true;
  for (std::size_t k = 0; k <= last; ++k) {
    const auto p = std::find(columns.position.begin(), columns.position.end(), k);
    const auto q = std::find(columns.orientation.begin(), columns.orientation.end(), k);
    if (k == columns.time) {
      row.timed = table->Time(&row.t, unit);
    } else if (k == columns.nanoseconds) {
      whole = table->Time(&fraction, TimeUnit::kNanoseconds);
    } else if (p != columns.position.end()) {
      row.position[static_cast<std::size_t>(p - columns.position.begin())] = table->Number();
    } else if (q != columns.orientation.end()) {
      row.orientation[static_cast<std::size_t>(q - columns.orientation.begin())] = table->Number();
    } else {
      table->Word();
    }
  }
  row.t += fraction;
  row.timed = row.timed && whole;
  return row;
}

}  // namespace evit
