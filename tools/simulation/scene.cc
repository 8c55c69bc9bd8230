#include "tools/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evit::simulation {
namespace {

// Each returns the depth of the front-side hit, or infinity.
constexpr double kMiss = std::numeric_limits<double>::infinity();

double CastPlane(const Surface& s, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double slope = s.normal.dot(direction);
  if (slope >= 0) return kMiss;
  const double depth = s.normal.dot(s.origin - origin) / slope;
  if (depth <= 0) return kMiss;
  const Eigen::Vector3d local = origin + depth * direction - s.origin;
  const double u = local.dot(s.edge_s) / s.edge_s.squaredNorm();
  const double v = local.dot(s.edge_t) / s.edge_t.squaredNorm();
  if (s.kind == Surface::Kind::kDisc) {
    return (u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5) <= 0.25 ? depth : kMiss;
  }
  return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? depth : kMiss;
}

// Nearer root of |d * direction - centre|^2 == radius^2.
double NearRoot(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction, double radius) {
  const double a = direction.squaredNorm(), b = direction.dot(centre);
  const double discriminant = b * b - a * (centre.squaredNorm() - radius * radius);
  if (a <= 0 || discriminant < 0) return kMiss;
  const double depth = (b - std::sqrt(discriminant)) / a;
  return depth > 0 ? depth : kMiss;
}

double CastCylinder(const Surface& s, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double height = s.edge_t.norm();
  const Eigen::Vector3d axis = s.edge_t / height, centre = s.origin - origin;
  const double depth =
      NearRoot(centre - centre.dot(axis) * axis, direction - direction.dot(axis) * axis, s.radius);
  if (depth == kMiss) return kMiss;
  const double along = (depth * direction - centre).dot(axis);
  return along >= 0 && along <= height ? depth : kMiss;
}

}  // namespace

float LightOn(const Eigen::Vector3d& normal) {
  static const Eigen::Vector3d kLamp1 = Eigen::Vector3d(-0.5, 0.35, 0.8).normalized();
  static const Eigen::Vector3d kLamp2 = Eigen::Vector3d(-0.2, -0.9, 0.35).normalized();
  return static_cast<float>(0.45 + 0.4 * std::max(0.0, normal.dot(kLamp1)) +
                            0.25 * std::max(0.0, normal.dot(kLamp2)));
}

Hit CastRay(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Hit hit{-1, kMiss};
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& s = scene.surfaces[i];
    double depth = kMiss;
    if (s.kind == Surface::Kind::kSphere) {
      depth = NearRoot(s.origin - origin, direction, s.radius);
    } else if (s.kind == Surface::Kind::kCylinder) {
      depth = CastCylinder(s, origin, direction);
    } else {
      depth = CastPlane(s, origin, direction);
    }
    if (depth < hit.depth) hit = {static_cast<int>(i), depth};
  }
  if (hit.surface < 0) hit.depth = 0;
  return hit;
}

}  // namespace evit::simulation
