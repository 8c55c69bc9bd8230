#pragma once

#include "tests/helpers/sample_messages.h"

/// Valid messages of map_server and of what asks it, with something in every field.
namespace evit {

template <>
inline map_points_t Sample<map_points_t>(int n) {
  map_points_t m{};
  Stamp(&m);
  m.query_seq = 4;
  m.query_epoch = 99;
  m.map_size = 1000;
  m.map_id = -7;
  m.n_visible = n + 10;
  m.n = n;
  for (int i = 0; i < n; ++i) {
    m.x.push_back(static_cast<float>(i)), m.y.push_back(2), m.z.push_back(3);
    m.id.push_back(3 * i);
  }
  return m;
}

template <>
inline map_query_t Sample<map_query_t>(int /*n*/) {
  map_query_t m{};
  Stamp(&m);
  SetPose(m.position, m.orientation);
  m.camera.model = "plumb_bob";
  m.camera.width = 640;
  m.camera.height = 480;
  m.camera.fx = m.camera.fy = 327.3;
  m.camera.cx = 304.7;
  m.camera.cy = 235.4;
  m.camera.distortion[0] = -0.03;
  m.margin_px = 20;
  m.min_depth = 0.1;
  m.max_depth = 10;
  m.occlusion = 1;
  m.max_points = 3000;
  m.seed = 5;
  return m;
}

template <>
inline map_view_t Sample<map_view_t>(int n) {
  map_view_t m{};
  Stamp(&m);
  m.query_seq = 4;
  m.query_epoch = 99;
  m.width = n + 2;
  m.height = 3;
  m.size = m.width * m.height;
  m.min_depth = 0.1;
  for (int i = 0; i < m.size; ++i) {
    m.log_intensity.push_back(static_cast<std::int16_t>(-100 * i));
    m.inverse_depth.push_back(static_cast<std::int16_t>(7000 * i));
  }
  return m;
}

template <>
inline place_query_t Sample<place_query_t>(int n) {
  place_query_t m{};
  Stamp(&m);
  SetPose(m.position, m.orientation);
  m.camera.model = "plumb_bob";
  m.camera.width = 12;
  m.camera.height = 10;
  m.camera.fx = m.camera.fy = 8;
  m.camera.cx = 5.5;
  m.camera.cy = 4.5;
  m.up[2] = 1;
  m.everywhere = 1;
  m.attempt = 3;
  m.near_radius = -1;
  m.height_low = 0.5;
  m.height_high = 2;
  m.yaw = 1;
  m.yaw_tolerance = 0.25;
  m.n = n;
  for (int i = 0; i < n; ++i) {
    m.hypothesis_position.push_back({1.0 * i, 2.0, 3.0});
    m.hypothesis_orientation.push_back({0, 0, 0.6, 0.8});
  }
  m.surface_size = m.camera.width * m.camera.height;
  for (int i = 0; i < m.surface_size; ++i) m.surface.push_back(static_cast<std::uint8_t>(2 * i));
  return m;
}

template <>
inline place_prior_t Sample<place_prior_t>(int /*n*/) {
  place_prior_t m{};
  Stamp(&m);
  m.near_position[1] = 2.5;
  m.near_radius = 3;
  m.height_low = 0.5;
  m.height_high = 2;
  m.yaw = 1;
  m.yaw_tolerance = 0.25;
  return m;
}

template <>
inline places_t Sample<places_t>(int n) {
  places_t m{};
  Stamp(&m);
  m.query_seq = 4;
  m.query_epoch = 99;
  m.n = n;
  for (int i = 0; i < n; ++i) {
    m.position.push_back({1.0 * i, 2.0, 3.0});
    m.orientation.push_back({0, 0, 0.6, 0.8});
    m.significance.push_back(8.5 - i);
    m.likeness.push_back(20.25);
    m.n_points.push_back(900);
  }
  return m;
}

template <>
inline view_query_t Sample<view_query_t>(int /*n*/) {
  view_query_t m{};
  Stamp(&m);
  SetPose(m.position, m.orientation);
  m.camera.model = "plumb_bob";
  m.camera.width = 320;
  m.camera.height = 240;
  m.camera.fx = m.camera.fy = 160;
  m.camera.cx = 159.5;
  m.camera.cy = 119.5;
  m.min_depth = 0.1;
  m.max_depth = 10;
  return m;
}

}  // namespace evit
