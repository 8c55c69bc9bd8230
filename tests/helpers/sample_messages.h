#pragma once

#include <cstdint>

#include "common/bus/codec.h"

/// Valid messages with something in every field, for tests. `n`: length of the arrays.
namespace evit {

template <typename Message>
void Stamp(Message* m) {
  m->utime = 1'642'516'764'984'000;
  m->seq = 7;
  m->epoch = 1'000'000'007;
}

inline void SetPose(double (&position)[3], double (&orientation)[4]) {
  for (int i = 0; i < 3; ++i) position[i] = 0.25 * (i + 1);
  orientation[0] = 0.1, orientation[1] = -0.7, orientation[2] = 0.1, orientation[3] = 0.7;
}

template <typename Message>
Message Sample(int n = 5);

template <>
inline body_pose_t Sample<body_pose_t>(int /*n*/) {
  body_pose_t m{};
  Stamp(&m);
  SetPose(m.position, m.orientation);
  m.velocity[1] = -1.5;
  return m;
}

template <>
inline credit_t Sample<credit_t>(int /*n*/) {
  credit_t m{};
  Stamp(&m);
  m.consumer = "frame_builder";
  m.stream_epoch = 3;
  m.next_events_seq = 12;
  m.next_imu_seq = -1;
  return m;
}

template <>
inline event_packet_t Sample<event_packet_t>(int n) {
  event_packet_t m{};
  Stamp(&m);
  m.n = n;
  for (int i = 0; i < n; ++i) {
    m.dt_us.push_back(i / 2);
    m.x.push_back(static_cast<std::int16_t>(i % 640));
    m.y.push_back(static_cast<std::int16_t>(i % 480));
    m.polarity.push_back(static_cast<std::uint8_t>(i % 2));
  }
  return m;
}

template <>
inline imu_batch_t Sample<imu_batch_t>(int n) {
  imu_batch_t m{};
  Stamp(&m);
  m.n = n;
  for (int i = 0; i < n; ++i) {
    m.sample_utime.push_back(m.utime + std::int64_t{5000} * i);
    m.gyro.push_back({0.1 * i, 0.2, -0.3});
    m.accel.push_back({0.0, 9.81, 0.1 * i});
  }
  return m;
}

template <>
inline keyframe_t Sample<keyframe_t>(int n) {
  keyframe_t m{};
  Stamp(&m);
  m.previous_utime = m.utime - std::int64_t{5000} * n;
  m.high_rate = 1;
  m.n_events = 10'000;
  m.decay_us = 20'000;
  m.lookahead_us = 40'000;
  m.width = n + 3;
  m.height = 4;
  m.encoding = keyframe_t::EVENT_COUNT;
  m.from_utime = m.utime - 2000;
  m.surface_size = m.width * m.height;
  m.surface.assign(static_cast<std::size_t>(m.surface_size), 200);
  m.n_imu = n;
  for (int i = 0; i < n; ++i) {
    m.imu_utime.push_back(m.previous_utime + std::int64_t{5000} * i);
    m.gyro.push_back({0.1 * i, 0.2, -0.3});
    m.accel.push_back({0.0, 9.81, 0.1 * i});
  }
  m.imu_gap_us = 5000;
  return m;
}

template <>
inline replay_control_t Sample<replay_control_t>(int /*n*/) {
  replay_control_t m{};
  Stamp(&m);
  m.command = replay_control_t::SPEED;
  m.speed = 2.5;
  return m;
}

template <>
inline service_status_t Sample<service_status_t>(int n) {
  service_status_t m{};
  Stamp(&m);
  m.service = "map_server";
  m.state = "running";
  m.detail = "";
  m.progress = 0.5;
  m.granted_receive_buffer = 4 << 20;
  m.n_counters = n;
  m.n_timings = n;
  for (int i = 0; i < n; ++i) {
    m.counter_name.push_back("EVENTS.lost" + std::to_string(i));
    m.counter_value.push_back(100 + i);
    m.timing_name.push_back("render" + std::to_string(i));
    m.timing_ms.push_back(0.5 * i);
  }
  return m;
}

template <>
inline stream_end_t Sample<stream_end_t>(int /*n*/) {
  stream_end_t m{};
  Stamp(&m);
  m.n_events_messages = 100;
  m.n_imu_messages = 200;
  return m;
}

template <>
inline tracker_mode_t Sample<tracker_mode_t>(int /*n*/) {
  tracker_mode_t m{};
  Stamp(&m);
  m.keyframe_seq = -1;
  m.keyframe_epoch = 4;
  m.mode = tracker_mode_t::LOST;
  m.reason = "too few points";
  m.image_speed = 120;
  m.useful_interval_us = 40'000;
  m.keyframe_stride = 2;
  return m;
}

template <>
inline window_state_t Sample<window_state_t>(int n) {
  window_state_t m{};
  Stamp(&m);
  m.keyframe_seq = 11;
  m.mode = tracker_mode_t::TRACKING;
  m.n_nodes = n;
  for (int i = 0; i < n; ++i) {
    node_state_t node{};
    node.utime = m.utime + std::int64_t{20'000} * i;
    node.keyframe_seq = i;
    SetPose(node.position, node.orientation);
    m.node.push_back(node);
  }
  m.covariance[5][5] = 1e-5;
  m.n_points = 500;
  m.inlier_share = 0.8;
  m.mean_cost = 90;
  m.n_iterations = 4;
  m.lookahead_us = 12'000;
  m.solve_ms = 3;
  m.total_ms = 5;
  return m;
}

}  // namespace evit
