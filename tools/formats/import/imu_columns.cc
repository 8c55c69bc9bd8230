#include "tools/formats/import/imu_columns.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace evit::formats {
namespace {

constexpr double kSlowest = 0.2;  // s: IMUs read more often than this

std::string Letters(const std::string& word) {
  std::string letters;
  for (const char c : word) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0)
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return letters;
}

int FieldNamed(const std::string& word) {
  const std::string name = Letters(word);
  const auto begins = [&](std::initializer_list<const char*> heads) {
    return std::any_of(heads.begin(), heads.end(),
                       [&](const char* head) { return name.rfind(head, 0) == 0; });
  };
  const bool t = !word.empty() && (word[0] == 't' || word[0] == 'T') &&
                 (word.size() == 1 || std::isalpha(static_cast<unsigned char>(word[1])) == 0);
  if (t || begins({"time", "stamp", "ts"})) return ImuColumns::kTime;
  const char axis = name.empty() ? '\0' : name.back();
  if (axis < 'x' || axis > 'z') return ImuColumns::kIgnored;
  if (begins({"w", "g", "omega", "ang", "rot"})) return ImuColumns::kGyro + (axis - 'x');
  if (begins({"a", "lin", "f", "imuacc"})) return ImuColumns::kAccel + (axis - 'x');
  return ImuColumns::kIgnored;
}

}  // namespace

ImuColumns FindImuColumns(const std::string& path, const std::string& layout, const std::vector<int>& usual) {
  const TableSample sample = SampleTable(path, layout);
  ImuColumns columns;
  columns.field = usual;
  std::vector<ColumnName> names = NamedColumns(sample.head);
  const std::size_t n = sample.rows.empty() ? 0 : sample.rows.front().size();
  if (names.size() + 1 == n)
    names.insert(names.begin(), {"", ""});  // an index column without a name (pandas)
  if (names.size() == n) {
    std::vector<int> named;
    std::multiset<int> found;
    for (const ColumnName& name : names) {
      named.push_back(FieldNamed(name.name));
      if (named.back() != ImuColumns::kIgnored) found.insert(named.back());
    }
    if (found == std::multiset<int>{0, 1, 2, 3, 4, 5, 6}) columns.field = named;
  }
  const auto time = std::find(columns.field.begin(), columns.field.end(), int{ImuColumns::kTime});
  columns.unit = UnitOfStamps(sample, static_cast<std::size_t>(time - columns.field.begin()), kSlowest);
  return columns;
}

bool ReadImuRow(const ImuColumns& columns, TableReader* rows, ImuSample* sample) {
  bool finite = true;
  for (const int field : columns.field) {
    if (field == ImuColumns::kTime) {
      finite = rows->Time(&sample->t, columns.unit);
    } else if (field < ImuColumns::kAccel) {
      sample->gyro[field - ImuColumns::kGyro] = rows->Number();
    } else if (field < ImuColumns::kIgnored) {
      sample->accel[field - ImuColumns::kAccel] = rows->Number();
    } else {
      rows->Word();
    }
  }
  return finite && sample->accel.allFinite() && sample->gyro.allFinite();
}

}  // namespace evit::formats
