#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "common/diagnosis/event_excerpts.h"
#include "common/diagnosis/excerpt_views.h"
#include "tests/helpers/clouds.h"

/// A small world for the doctor's checks: lines at several depths, a camera that waves before them, and the
/// events that it makes of them.
namespace evit::test {

/// Short lines around the map's origin, 1 m deep: points 2 cm apart, a pixel or two.
inline PointMap Lines(int n = 36) {
  std::mt19937 random(5);
  PointMap map;
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector3f from(Uniform(&random, -2.4F, 2.2F), Uniform(&random, -1.9F, 1.7F),
                               Uniform(&random, 0, 1));
    const float turn = Uniform(&random, -1.5F, 1.5F), length = Uniform(&random, 0.4F, 0.7F);
    for (float s = 0; s < length; s += 0.02F)
      map.points.push_back(from + s * Eigen::Vector3f(std::cos(turn), std::sin(turn), 0.2F));
  }
  return map;
}

/// From -1 s to 7 s, by IMU time. The body that is stamped t stands where a hand waves it at `time`(t), some
/// 2 m before the lines.
inline Trajectory Waving(const std::function<Utime(Utime)>& time = [](Utime t) { return t; }) {
  Trajectory body;
  for (Utime t = -1'000'000; t <= 7'000'000; t += 10'000) {
    const double s = ToSeconds(time(t));
    body.push_back({t,
                    {ExpSO3({0.2 * std::sin(3.3 * s), 0.25 * std::sin(4.1 * s + 1), 0.2 * std::sin(2.7 * s)}),
                     {0.25 * std::sin(1.3 * s), 0.2 * std::sin(1.9 * s + 2), -2 + 0.2 * std::sin(1.1 * s)}}});
  }
  return body;
}

/// The world as it is, all known: the camera a few centimetres and degrees off the body, its clock 7 ms
/// behind the IMU's.
inline diagnosis::World LineWorld() {
  diagnosis::World world;
  Camera& camera = world.rig.camera;
  camera.width = 160, camera.height = 120;
  camera.fx = camera.fy = 125;
  camera.cx = 81, camera.cy = 59;
  world.rig.T_body_camera = {ExpSO3({0.02, -0.03, 0.05}), {0.03, -0.02, 0.04}};
  world.rig.camera_time_offset = 7'000;
  world.truth = Waving();
  return world;
}

/// `n` instants from 0 to 6 s, events' clock.
inline std::vector<Utime> Instants(int n) {
  std::vector<Utime> instants(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) instants[static_cast<std::size_t>(k)] = 6'000'000LL * k / (n - 1);
  return instants;
}

/// What a camera of the world makes of the map's points around the instants: an event where one comes to
/// another pixel, but only in `share`, of 1, of these cases (drawn by chance).
inline diagnosis::EventExcerpts EventsOf(const PointMap& map, const diagnosis::World& world,
                                         const std::vector<Utime>& instants, double share = 1) {
  constexpr Utime kReach = 25'000, kStep = 1'000;  // us
  std::mt19937 random(7);
  diagnosis::EventExcerpts excerpts(instants, kReach);
  for (const Utime instant : instants) {
    EventArray events;
    PixelSet before;
    for (Utime t = instant - kReach; t < instant + kReach; t += kStep) {
      PixelSet now(world.rig.camera.width, world.rig.camera.height);
      SE3 T_map_body;
      if (!PoseAt(world.truth, t + world.rig.camera_time_offset, &T_map_body)) continue;
      const SE3 T_camera_map = (T_map_body * world.rig.T_body_camera).Inverse();
      for (const Eigen::Vector3f& p : map.points) {
        Eigen::Vector2d pixel;
        if (!world.rig.camera.Project(T_camera_map * p.cast<double>(), &pixel)) continue;
        const auto x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
        if (!world.rig.camera.Contains(pixel) || now.Has(x, y)) continue;
        now.Add(x, y);
        if (before.width() > 0 && !before.Has(x, y) && Uniform(&random) < share)
          events.push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 1);
      }
      before = std::move(now);
    }
    excerpts.Add(events);
  }
  return excerpts;
}

}  // namespace evit::test
