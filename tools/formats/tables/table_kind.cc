#include "tools/formats/tables/table_kind.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/files/pose_columns.h"
#include "common/files/table_sample.h"
#include "tools/formats/import/event_columns.h"
#include "tools/formats/import/imu_columns.h"

namespace evit::formats {
namespace {

constexpr std::size_t kRows = 50;  // are looked at
constexpr double kUnit = 0.02;     // a quaternion's length may be off by so much: few digits

double NumberAt(const std::vector<std::string>& row, std::size_t column) {
  double value = std::nan("");
  if (column < row.size()) ParseNumber(row[column], &value);
  return value;
}

bool HoldsPoses(const TableSample& sample) {
  if (sample.rows.front().size() < 8 || HoldsMatrices(sample)) return false;
  const PoseColumns columns = PoseColumnsOf(sample);
  return std::all_of(sample.rows.begin(), sample.rows.end(), [&](const std::vector<std::string>& row) {
    double sum = 0;
    for (const std::size_t column : columns.orientation) {
      const double value = NumberAt(row, column);
      sum += value * value;
    }
    return std::isfinite(NumberAt(row, columns.time)) && std::abs(std::sqrt(sum) - 1) < kUnit;
  });
}

bool HoldsImu(const TableSample& sample, const std::string& path) {
  if (sample.rows.front().size() < 7) return false;
  FindImuColumns(sample, path, ImuOrder::kByGravity);  // throws where these are none
  return true;
}

}  // namespace

TableKind KindOfTable(const std::string& path) {
  try {
    const TableSample sample = SampleTable(path, "t ...", kRows);
    if (HoldsEvents(sample)) return TableKind::kEvents;
    if (sample.rows.empty()) return TableKind::kNone;
    if (HoldsPoses(sample)) return TableKind::kPoses;
    if (HoldsImu(sample, path)) return TableKind::kImu;
  } catch (const std::runtime_error&) {  // no text, or columns that say nothing
  }
  return TableKind::kNone;
}

}  // namespace evit::formats
