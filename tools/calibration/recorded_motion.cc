#include "tools/calibration/recorded_motion.h"

#include <cstdint>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/bus/log_prefix.h"
#include "common/wire/imu_wire.h"

namespace evit::calibration {

std::vector<ImuSample> ReadImu(const std::string& path, const ImuNoise& limits) {
  const LogReader log(path);
  std::vector<ImuSample> samples;
  std::vector<std::uint8_t> bytes;
  imu_batch_t message;
  const std::string channel = Channels(FindLogPrefix(path, log.channels(), "")).imu;
  for (const LogEntry& entry : log.entries()) {
    if (log.channel(entry) != channel) continue;
    log.Read(entry, &bytes);
    if (!DecodeChecked(bytes.data(), bytes.size(), &message)) continue;
    for (const ImuSample& s : SamplesOf(message)) {
      if (s.gyro.cwiseAbs().maxCoeff() <= 1.1 * limits.gyro_range &&
          s.accel.cwiseAbs().maxCoeff() <= 1.1 * limits.accel_range) {
        samples.push_back(s);
      }
    }
  }
  if (samples.empty()) throw std::runtime_error(path + ": holds no IMU samples; record IMU beside EVENTS");
  return samples;
}

Trajectory CameraOf(const Trajectory& body, const Rig& rig) {
  Trajectory camera;
  camera.reserve(body.size());
  for (const StampedPose& s : body) {
    camera.push_back({s.t - rig.camera_time_offset, s.pose * rig.T_body_camera});
  }
  return camera;
}

}  // namespace evit::calibration
