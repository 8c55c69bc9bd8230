#include "tools/formats/vector/imu_file.h"

#include <stdexcept>

#include "common/files/table_reader.h"
#include "tools/formats/import/imu_columns.h"

namespace evit::formats {

std::vector<ImuSample> ReadImuFile(const std::string& path, DropCounts* dropped) {
  constexpr char kLayout[] = "timestamp gx gy gz ax ay az";
  const ImuColumns columns = FindImuColumns(path, kLayout, {0, 1, 2, 3, 4, 5, 6});
  TableReader rows(path, kLayout);
  std::vector<ImuSample> samples;
  while (rows.Next()) {
    ImuSample s;
    const bool finite = ReadImuRow(columns, &rows, &s);
    AppendValid(s, finite, &samples, dropped);
  }
  if (samples.size() < 2) throw std::runtime_error(path + ": contains no IMU samples");
  return samples;
}

}  // namespace evit::formats
