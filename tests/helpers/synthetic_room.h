#pragma once

// A room of line segments on four walls, floor and shelves, and what a body in it sees.
#include <random>
#include <vector>

#include "common/localization/place_finder.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit::synthetic {

/// Segments on the walls of a room of 4 x 4 x 2.4 m around the origin. `copies` 2: its second half is the
/// first, turned by 180 degrees about the vertical; 4: all walls are the first, turned.
inline PointMap WalledRoom(unsigned seed, int copies = 1) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> u(-1, 1);
  PointMap map;
  const int lines = 160 / copies;
  for (int k = 0; k < lines; ++k) {
    const int wall = static_cast<int>(rng() % (4 / copies));
    const bool level = rng() % 2 == 0;
    const float s = 1.9F * u(rng), z = 1.1F * u(rng), length = 0.2F + 0.3F * std::abs(u(rng));
    const float depth = 2.0F - 0.4F * std::abs(u(rng));  // on shelves and boxes, too
    for (float a = 0; a < length; a += 0.01F) {
      const float t = level ? s + a : s, h = level ? z : z + a;
      const Eigen::Vector3f on_wall[] = {{depth, t, h}, {t, depth, h}, {-depth, t, h}, {t, -depth, h}};
      const Eigen::Vector3f p = on_wall[wall];
      map.points.push_back(p);
      if (copies == 4) map.points.emplace_back(-p.y(), p.x(), p.z());
      if (copies > 1) map.points.emplace_back(-p.x(), -p.y(), p.z());
      if (copies == 4) map.points.emplace_back(p.y(), -p.x(), p.z());
    }
  }
  return map;
}

/// What stands in a room, ready to be asked.
struct IndexedRoom {
  explicit IndexedRoom(PointMap points)
      : places(points, Options()), index(std::move(points)), finder(index, places, TestRig(), {}, {}, {}) {}
  static PlaceIndexOptions Options() {
    PlaceIndexOptions options;
    options.grid.spacing = 0.35;
    options.grid.beyond = options.grid.beyond_open = 0;
    options.grid.max_places = 3000;
    return options;
  }
  static Rig TestRig() {
    Rig rig;
    rig.camera = VgaCamera();
    rig.T_body_camera = BodyCamera();
    rig.imu_noise = {7e-4, 1.3e-3, 7e-6, 6e-5};
    return rig;
  }
  PlaceIndex places;
  MapIndex index;
  PlaceFinder finder;
};

/// Made once for all tests.
inline const IndexedRoom& TheRoom() {
  static const IndexedRoom room(WalledRoom(1));
  return room;
}
inline const IndexedRoom& OtherRoom() {
  static const IndexedRoom room(WalledRoom(2));
  return room;
}
inline const IndexedRoom& TwoSidedRoom() {
  static const IndexedRoom room(WalledRoom(3, 2));
  return room;
}

inline const IndexedRoom& FourSidedRoom() {
  static const IndexedRoom room(WalledRoom(3, 4));
  return room;
}

/// Motion about a point of the room, with any heading.
struct MotionInRoom : Motion {
  Eigen::Vector3d about = Eigen::Vector3d::Zero();
  double heading = 0;
  SE3 PoseAt(double t) const {
    const Eigen::Quaterniond turn = ExpSO3({0, 0, heading});
    return {turn * Rotation(t), about + turn * Position(t)};
  }
};

inline cv::Mat SeenFrom(const PointMap& map, const SE3& T_map_body) {
  return DrawSurface(Alignment(), map.points, T_map_body);
}

}  // namespace evit::synthetic
