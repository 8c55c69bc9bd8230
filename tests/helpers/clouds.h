#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "common/map/map_index.h"

/// Clouds and cameras for the tests of the map index.
namespace evit::test {

/// 0..1, the same on every platform.
inline float Uniform(std::mt19937* random) { return static_cast<float>((*random)()) / 4294967296.0F; }
inline float Uniform(std::mt19937* random, float a, float b) { return a + (b - a) * Uniform(random); }

/// VECtor's event camera.
inline Camera PlumbBob() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 327.3;
  camera.fy = 327.5;
  camera.cx = 305;
  camera.cy = 235.4;
  camera.distortion = {-0.032, 0.042, -0.0005, -0.001, 0};
  return camera;
}

/// Barrel distortion whose polynomial turns around at some 50 degrees, inside the image's corners.
inline Camera StrongBarrel() {
  Camera camera = PlumbBob();
  camera.distortion = {-0.25, 0.01, 0, 0, 0};
  return camera;
}

inline Camera Fisheye() {
  Camera camera = PlumbBob();
  camera.model = Camera::Model::kEquidistant;
  camera.fx = camera.fy = 220;
  camera.distortion = {-0.02, 0.005, -0.002, 0.0003, 0};
  return camera;
}

/// Points of a box's surface, `half` its half sides, seeded.
inline PointMap Room(std::size_t n, const Eigen::Vector3f& half, unsigned seed) {
  std::mt19937 random(seed);
  PointMap map;
  for (std::size_t k = 0; k < n; ++k) {
    Eigen::Vector3f p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = Uniform(&random, -half[axis], half[axis]);
    const int axis = static_cast<int>(random() % 3);
    p[axis] = random() % 2 == 0 ? half[axis] : -half[axis];
    map.points.push_back(p);
  }
  return map;
}

/// A camera somewhere in a box, looking anywhere.
inline SE3 RandomPose(std::mt19937* random, float reach) {
  Eigen::Vector4d q;
  for (int k = 0; k < 4; ++k) q[k] = Uniform(random, -1, 1);
  const Eigen::Vector3d p(Uniform(random, -reach, reach), Uniform(random, -reach, reach),
                          Uniform(random, -reach, reach));
  return {Eigen::Quaterniond(q.normalized()), p};
}

}  // namespace evit::test
