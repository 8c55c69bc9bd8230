#pragma once

#include <type_traits>

#include "common/bus/codec.h"

namespace evit {

/// Calls visit(name, count, vector) for each array of `m` whose length another field says. Generated code
/// keeps the two apart: encoding with a vector that is too short would read past its end, and decoding a
/// message with n = 0 into a used object would leave the old vector there.
template <typename Message, typename Visitor>
void VisitArrays(Message& m, const Visitor& visit) {
  using Type = std::remove_const_t<Message>;
  if constexpr (std::is_same_v<Type, event_packet_t>) {
    visit("dt_us", m.n, m.dt_us);
    visit("x", m.n, m.x);
    visit("y", m.n, m.y);
    visit("polarity", m.n, m.polarity);
  } else if constexpr (std::is_same_v<Type, imu_batch_t>) {
    visit("sample_utime", m.n, m.sample_utime);
    visit("gyro", m.n, m.gyro);
    for (auto& row : m.gyro) visit("gyro[i]", 3, row);
    visit("accel", m.n, m.accel);
    for (auto& row : m.accel) visit("accel[i]", 3, row);
  } else if constexpr (std::is_same_v<Type, keyframe_t>) {
    visit("surface", m.n_surfaces, m.surface);
    for (auto& row : m.surface) visit("surface[i]", m.surface_size, row);
    visit("imu_utime", m.n_imu, m.imu_utime);
    visit("gyro", m.n_imu, m.gyro);
    for (auto& row : m.gyro) visit("gyro[i]", 3, row);
    visit("accel", m.n_imu, m.accel);
    for (auto& row : m.accel) visit("accel[i]", 3, row);
  } else if constexpr (std::is_same_v<Type, map_points_t>) {
    visit("xyz", m.n, m.xyz);
    for (auto& row : m.xyz) visit("xyz[i]", 3, row);
    visit("id", m.n, m.id);
  } else if constexpr (std::is_same_v<Type, map_view_t>) {
    visit("log_intensity", m.size, m.log_intensity);
    visit("inverse_depth", m.size, m.inverse_depth);
  } else if constexpr (std::is_same_v<Type, service_status_t>) {
    visit("counter_name", m.n_counters, m.counter_name);
    visit("counter_value", m.n_counters, m.counter_value);
    visit("timing_name", m.n_timings, m.timing_name);
    visit("timing_ms", m.n_timings, m.timing_ms);
  } else if constexpr (std::is_same_v<Type, window_state_t>) {
    visit("node", m.n_nodes, m.node);
  }
}

}  // namespace evit
