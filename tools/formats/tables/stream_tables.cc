#include "tools/formats/tables/stream_tables.h"

#include <stdexcept>

#include "common/files/pose_columns.h"
#include "common/files/table_reader.h"
#include "common/files/table_sample.h"
#include "tools/formats/import/imu_columns.h"

namespace evit::formats {
namespace {

constexpr double kSlowestPose = 5;  // s between two rows
constexpr char kImuLayout[] = "t gx gy gz ax ay az (or ax ay az gx gy gz)";
constexpr char kPoseLayout[] = "t x y z qx qy qz qw";

}  // namespace

std::vector<ImuSample> ReadImuTable(const std::string& path, DropCounts* dropped) {
  return ReadImuRows(path, kImuLayout, ImuOrder::kByGravity, dropped);
}

Trajectory ReadPoseTable(const std::string& path, DropCounts* dropped) {
  const TableSample sample = SampleTable(path, kPoseLayout);
  if (sample.rows.empty() || sample.rows.front().size() < 8)
    throw std::runtime_error(path + ": is not a trajectory; expected " + kPoseLayout);
  const PoseColumns columns = PoseColumnsOf(sample);
  if (HoldsMatrices(sample))
    throw std::runtime_error(path + ": holds matrices; expected rows of " + kPoseLayout);
  const TimeUnit unit = UnitOfPoses(sample, columns, kSlowestPose);
  TableReader rows(path, kPoseLayout);
  Trajectory poses;
  while (rows.Next()) {
    if (rows.CutOff(sample.rows.front().size())) {
      dropped->cut_off = true;
      break;
    }
    const PoseRow row = ReadPoseRow(columns, unit, &rows);
    AppendPose({row.t,
                {Eigen::Map<const Eigen::Quaterniond>(row.orientation.data()),
                 Eigen::Map<const Eigen::Vector3d>(row.position.data())}},
               row.timed, &poses, dropped);
  }
  return poses;
}

}  // namespace evit::formats
