#include "tools/mapping/gravity_direction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/geometry/degrees.h"
#include "common/text/words.h"
#include "common/wire/imu_wire.h"

namespace evit::mapping {
namespace {

constexpr std::size_t kFewest = 100;  // samples

}  // namespace

void GravityMean::Add(const ImuSample& sample) {
  SE3 pose;
  if (!PoseAt(body_, sample.t, &pose)) return;
  sum_ += pose.q * sample.accel;
  ++n_;
}

double GravityMean::TiltDegrees() const {
  return std::acos(std::clamp(up().z(), -1.0, 1.0)) * kDegreesPerRadian;
}

SE3 UprightRotation(const std::string& path, const Trajectory& body, const std::string& body_path) {
  const LogReader log(path);
  GravityMean gravity(body);
  std::vector<std::uint8_t> bytes;
  for (const auto& entry : log.entries()) {
    if (!EndsWith(log.channel(entry), "IMU")) continue;
    log.Read(entry, &bytes);
    imu_batch_t batch;
    if (!DecodeChecked(bytes.data(), bytes.size(), &batch)) continue;
    for (const ImuSample& sample : SamplesOf(batch)) gravity.Add(sample);
  }
  if (gravity.n() < kFewest) {
    throw std::runtime_error(path + ": holds " + std::to_string(gravity.n()) +
                             " IMU samples at the times of " + body_path +
                             ", too few to tell where up is; are both of one recording?");
  }
  return {Eigen::Quaterniond::FromTwoVectors(gravity.up(), Eigen::Vector3d::UnitZ()),
          Eigen::Vector3d::Zero()};
}

}  // namespace evit::mapping
