#include "tools/formats/hdf5/h5_streams.h"

#include <Eigen/Geometry>
#include <cmath>

#include "tools/formats/hdf5/h5_sample.h"
#include "tools/formats/hdf5/h5_stamps.h"

namespace evit::formats {
namespace {

constexpr std::size_t kMaxRows = 100'000'000;

// Stamps of a stream in any unit.
std::vector<Utime> ReadStamps(const H5Rows& rows) {
  constexpr double kSlowest = 5;  // s between two rows
  if (rows.columns() != 1 || rows.rows() > kMaxRows) rows.Fail("expected one stamp a row");
  const TimeUnit unit = UnitOfStamps(SampleColumns({&rows}, ""), 0, kSlowest);
  H5Stamps to_micros(unit, nullptr);
  std::vector<Utime> stamps;
  if (rows.is_integer()) {
    stamps = rows.ReadAll<std::int64_t>();
    to_micros.FromIntegers(&stamps);
  } else {
    for (const double t : rows.ReadAll<double>()) stamps.push_back(to_micros.FromDouble(t));
  }
  return stamps;
}

std::vector<double> ReadTable(const H5Rows& rows, std::size_t columns, std::size_t n) {
  if (rows.columns() != columns || rows.rows() != n) {
    rows.Fail("has " + std::to_string(rows.rows()) + " rows of " + std::to_string(rows.columns()) +
              " numbers, expected " + std::to_string(n) + " of " + std::to_string(columns));
  }
  return rows.ReadAll<double>();
}

void AddImu(const std::vector<Utime>& t, const double* gyro, const double* accel, std::size_t stride,
            ImportStreams* out) {
  for (std::size_t k = 0; k < t.size(); ++k) {
    const ImuSample s{t[k], Eigen::Vector3d(gyro + stride * k), Eigen::Vector3d(accel + stride * k)};
    AppendValid(s, s.t != H5Stamps::kNoTime && s.gyro.allFinite() && s.accel.allFinite(), &out->imu,
                &out->dropped_imu);
  }
}

// 4x4 matrices; `inverted`: they take the world into the camera.
void AddTruth(const std::vector<Utime>& t, const std::vector<double>& matrices, bool inverted,
              ImportStreams* out) {
  for (std::size_t k = 0; k < t.size(); ++k) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrices.data() + 16 * k);
    const Eigen::Matrix3d R = T.linear();
    const bool rotation = t[k] != H5Stamps::kNoTime && T.matrix().allFinite() &&
                          (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-2;
    if (rotation && inverted) T = T.inverse();
    StampedPose pose{t[k], {}};
    pose.pose.p = T.translation();
    if (rotation) pose.pose.q = Eigen::Quaterniond(T.linear());
    AppendPose(pose, rotation, &out->truth, &out->dropped_truth);
  }
}

}  // namespace

void ReadH5Streams(const H5File& file, ImportStreams* streams) {
  for (const std::string& dataset : file.datasets()) {
    const std::size_t slash = dataset.rfind('/');
    const std::string group = slash == std::string::npos ? "" : dataset.substr(0, slash + 1),
                      name = dataset.substr(group.size());
    if (group.find("right") != std::string::npos) continue;
    if (name == "omega" && file.Has(group + "accel") && file.Has(group + "ts") && streams->imu.empty()) {
      const std::vector<Utime> t = ReadStamps(file.Open(group + "ts"));
      const std::vector<double> gyro = ReadTable(file.Open(dataset), 3, t.size()),
                                accel = ReadTable(file.Open(group + "accel"), 3, t.size());
      AddImu(t, gyro.data(), accel.data(), 3, streams);
      streams->imu_name = file.path() + ": " + group;
    } else if (name == "imu" && file.Has(group + "imu_ts") && streams->imu.empty()) {
      const std::vector<Utime> t = ReadStamps(file.Open(group + "imu_ts"));
      const std::vector<double> values = ReadTable(file.Open(dataset), 6, t.size());
      AddImu(t, values.data() + 3, values.data(), 6, streams);
      streams->imu_name = file.path() + ": " + dataset;
    } else if (name == "pose" && file.Has(group + "pose_ts") && streams->truth.empty()) {
      const std::vector<Utime> t = ReadStamps(file.Open(group + "pose_ts"));
      AddTruth(t, ReadTable(file.Open(dataset), 16, t.size()), false, streams);
    } else if (name == "Cn_T_C0" && file.Has(group + "ts") && streams->truth.empty()) {
      const std::vector<Utime> t = ReadStamps(file.Open(group + "ts"));
      AddTruth(t, ReadTable(file.Open(dataset), 16, t.size()), true, streams);
    }
  }
}

}  // namespace evit::formats
