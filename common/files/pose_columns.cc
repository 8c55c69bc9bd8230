#include "common/files/pose_columns.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "common/text/words.h"

namespace evit {
namespace {

constexpr std::size_t kNone = -1;  // no column

bool IsTime(const std::string& name) {
  for (const char* known : {"t", "ts", "time", "timestamp", "stamp"})
    if (name == known) return true;
  return EndsWith(name, "timestamp") || EndsWith(name, ".stamp");
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
  PoseColumns found{kNone, {kNone, kNone, kNone}, {kNone, kNone, kNone, kNone}};
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
  const auto none = [](const auto& columns) {
    return std::find(columns.begin(), columns.end(), kNone) != columns.end();
  };
  return found.time == kNone || none(found.position) || none(found.orientation) ? PoseColumns() : found;
}

PoseRow ReadPoseRow(const PoseColumns& columns, TimeUnit unit, TableReader* table) {
  const std::size_t last =
      std::max({columns.time, *std::max_element(columns.position.begin(), columns.position.end()),
                *std::max_element(columns.orientation.begin(), columns.orientation.end())});
  PoseRow row;
  for (std::size_t k = 0; k <= last; ++k) {
    const auto p = std::find(columns.position.begin(), columns.position.end(), k);
    const auto q = std::find(columns.orientation.begin(), columns.orientation.end(), k);
    if (k == columns.time) {
      row.timed = table->Time(&row.t, unit);
    } else if (p != columns.position.end()) {
      row.position[static_cast<std::size_t>(p - columns.position.begin())] = table->Number();
    } else if (q != columns.orientation.end()) {
      row.orientation[static_cast<std::size_t>(q - columns.orientation.begin())] = table->Number();
    } else {
      table->Word();
    }
  }
  return row;
}

}  // namespace evit
