#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <deque>
#include <vector>

#include "tools/simulation/texture.h"

namespace evit::simulation {

/// One surface of a scene, in the map frame (metres, z up). Only its front is seen.
struct Surface {
  enum class Kind { kRectangle, kDisc, kSphere, kCylinder };

  Kind kind = Kind::kRectangle;
  /// Rectangle, disc: the corner at texture (0, 0); sphere: its centre; cylinder: the centre of its base.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Rectangle, disc (inscribed in that rectangle): the sides along texture s and t, at right angles.
  /// Cylinder: edge_t is its axis, as long as it is high.
  Eigen::Vector3d edge_s = Eigen::Vector3d::Zero(), edge_t = Eigen::Vector3d::Zero();
  double radius = 0;                                  // sphere, cylinder
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // rectangle, disc: unit, points to the front
  const Texture* texture = nullptr;
  float gain = 1;  // rectangle, disc: light that falls on it; curved surfaces are shaded point by point
};

/// Light on a surface whose unit normal points to the front: an ambient share and two distant lamps.
float LightOn(const Eigen::Vector3d& normal);

/// A rigid world.
struct Scene {
  std::vector<Surface> surfaces;
  std::deque<Texture> textures;    // does not move its elements: surfaces point to them
  Eigen::AlignedBox3d free_space;  // no surface within: where the camera may be
  Eigen::Vector3d desk =
      Eigen::Vector3d::Zero();  // middle of the top of a desk beside the free space, towards +y

  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) = default;
  Scene& operator=(Scene&&) = default;
};

/// Where a ray first meets the scene.
struct Hit {
  int surface = -1;  // index, -1: none
  double depth = 0;  // in units of the direction's length
};
Hit CastRay(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace evit::simulation
