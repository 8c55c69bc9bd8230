#include "tools/formats/numpy/npy_imu.h"

#include <optional>
#include <stdexcept>

#include "tools/formats/import/imu_columns.h"
#include "tools/formats/numpy/npy_table.h"

namespace evit::formats {
namespace {

constexpr std::uint64_t kBlock = 10'000;     // rows at a time
constexpr std::uint64_t kMost = 50'000'000;  // samples: half a day of a fast IMU

std::string NameOf(const NpyTable& table) {
  std::string name;
  for (const NpyTable::Column& column : table.columns) {
    if (name.find(column.array) == std::string::npos) name += (name.empty() ? "" : ", ") + column.array;
  }
  return table.path + (name.empty() ? "" : ": " + name);
}

// The columns, if the table can be an IMU's.
std::optional<ImuColumns> ColumnsOf(const NpyTable& table) {
  try {
    const TableSample sample = SampleNpy(table);
    ImuColumns columns = FindImuColumns(sample, table.path, ImuOrder::kByGravity);
    const bool all_named = columns.field.size() == table.columns.size();
    if (all_named || table.columns.front().array == table.columns.back().array) return columns;
  } catch (const std::runtime_error&) {  // neither names nor gravity say so
  }
  return {};
}

class ImuRows {
 public:
  ImuRows(const NpyTable& table, const ImuColumns& columns)
      : table_(table), columns_(columns), rows_(table) {}

  void Read(ImportStreams* streams) {
    while (const std::uint64_t n = rows_.Read(kBlock)) {
      for (std::uint64_t row = 0; row < n; ++row) {
        ImuSample sample;
        const bool finite = Get(row, &sample);
        AppendValid(sample, finite, &streams->imu, &streams->dropped_imu);
      }
    }
  }

 private:
  // False where it is not finite.
  bool Get(std::uint64_t row, ImuSample* sample) const {
    Utime fraction = 0;
    for (std::size_t k = 0; k < columns_.field.size(); ++k) {
      const int field = columns_.field[k];
      if (field == ImuColumns::kIgnored) continue;
      if (field == ImuColumns::kTime || field == ImuColumns::kNanoseconds) {
        const bool whole = field == ImuColumns::kTime;
        const TimeUnit unit = whole ? columns_.unit : TimeUnit::kNanoseconds;
        if (!NpyTime(table_.columns[k].numbers, rows_.At(k, row), unit, whole ? &sample->t : &fraction))
          return false;
        continue;
      }
      const double value = NpyNumber(table_.columns[k].numbers, rows_.At(k, row));
      if (field < ImuColumns::kAccel)
        sample->gyro[field - ImuColumns::kGyro] = columns_.gyro_unit * value;
      else
        sample->accel[field - ImuColumns::kAccel] = columns_.accel_unit * value;
    }
    sample->t += fraction;
    return sample->gyro.allFinite() && sample->accel.allFinite();
  }

  const NpyTable& table_;
  const ImuColumns& columns_;
  NpyRows rows_;
};

}  // namespace

void ReadNpyImu(const std::string& path, ImportStreams* streams) {
  std::string found;
  for (const NpyTable& table : FindNpyImuTables(path)) {
    const std::optional<ImuColumns> columns = ColumnsOf(table);
    if (!columns) continue;
    if (!found.empty())
      throw std::runtime_error(found + " and " + NameOf(table) +
                               " may both be the IMU's; save one of them alone, or give --imu FILE");
    found = NameOf(table);
    if (table.rows > kMost)
      throw std::runtime_error(found + ": " + std::to_string(table.rows) + " rows are too many for an IMU");
    ImuRows(table, *columns).Read(streams);
    streams->imu_name = found;
  }
}

}  // namespace evit::formats
