#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"

/// Small recordings for tests.
namespace evit {

struct TestRecording {
  int packets = 100;  // EVENTS messages
  int events_per_packet = 50;
  std::int64_t begin_utime = 5'000'000;
  std::int64_t packet_us = 10'000;  // from one packet to the next; two IMU samples each, one GROUND_TRUTH
  std::string prefix;
  int backwards_packet = -1;  // this packet's events lie 1 s too early
  int broken_packet = -1;     // this packet's count is forged
};

inline void WriteTestRecording(const std::string& path, const TestRecording& recording) {
  const Channels channels(recording.prefix);
  LogWriter log(path);
  std::vector<std::uint8_t> bytes;
  for (int p = 0; p < recording.packets; ++p) {
    const std::int64_t utime = recording.begin_utime + p * recording.packet_us;
    event_packet_t events{};
    events.utime = utime - (p == recording.backwards_packet ? 1'000'000 : 0);
    events.seq = 1000 + p;  // log_replay stamps its own
    events.epoch = 3;
    events.n = recording.events_per_packet;
    for (int i = 0; i < events.n; ++i) {
      events.dt_us.push_back(static_cast<std::int32_t>(i * recording.packet_us / events.n));
      events.x.push_back(static_cast<std::int16_t>(p % 640));
      events.y.push_back(static_cast<std::int16_t>(i % 480));
      events.polarity.push_back(static_cast<std::uint8_t>(i % 2));
    }
    EncodeTo(events, &bytes);
    if (p == recording.broken_packet) bytes[8 + 24] = 0x7F;
    log.Write(utime, channels.events, bytes.data(), bytes.size());
    body_pose_t pose{};
    pose.utime = utime;
    pose.orientation[3] = 1;
    EncodeTo(pose, &bytes);
    log.Write(pose.utime, channels.ground_truth, bytes.data(), bytes.size());
    log.Write(utime, recording.prefix + "SOMETHING_ELSE", "x", 1);
    for (int s = 0; s < 2; ++s) {
      imu_batch_t imu{};
      imu.utime = utime + s * recording.packet_us / 2;
      imu.n = 1;
      imu.sample_utime = {imu.utime};
      imu.gyro = {{0, 0, 0}};
      imu.accel = {{0, 0, 9.81}};
      EncodeTo(imu, &bytes);
      log.Write(imu.utime, channels.imu, bytes.data(), bytes.size());
    }
  }
  log.Close();
}

}  // namespace evit
