#include "tools/simulation/placed_surface.h"

#include <algorithm>

namespace evit::simulation {
namespace {

constexpr double kPi = 3.14159265358979;

}  // namespace

bool PlaceSurface(const Surface& surface, std::int32_t index, const Eigen::Matrix3d& R_map_camera,
                  const Eigen::Vector3d& p_map_camera, double focal, PlacedSurface* placed) {
  placed->surface = &surface;
  placed->index = index;
  const Eigen::Matrix3d R = R_map_camera.transpose();
  const Eigen::Vector3d origin = R * (surface.origin - p_map_camera);
  // Level 0 fits where one texel covers one pixel: at depth focal * texel_size.
  const double fit = 1.0 / (focal * surface.texture->texel_size());
  if (!placed->IsPlane()) {
    placed->R_map_camera = R_map_camera.cast<float>();
    placed->centre = origin.cast<float>();
    placed->height = static_cast<float>(surface.edge_t.norm());
    placed->axis = (R * surface.edge_t.normalized()).cast<float>();
    placed->lod_offset = static_cast<float>(std::log2(fit));
    return true;
  }
  const Eigen::Vector3d normal = R * surface.normal;
  const double distance = -normal.dot(origin);  // of the camera in front of the plane
  if (distance < 1e-3) return false;
  const Eigen::Vector3d w = -normal / distance;
  const auto along = [&](const Eigen::Vector3d& edge) -> Eigen::Vector3f {
    const Eigen::Vector3d scaled = R * edge / edge.squaredNorm();
    return (scaled - scaled.dot(origin) * w).cast<float>();
  };
  placed->w = w.cast<float>();
  placed->s = along(surface.edge_s);
  placed->t = along(surface.edge_t);
  // A pixel covers depth/focal across and depth^2/(focal*distance) along the slope: between the two.
  placed->lod_offset = static_cast<float>(std::log2(fit) - 0.6 * std::log2(distance));
  return true;
}

float PlacedSurface::MeetCurved(float x, float y) const {
  const Eigen::Vector3f ray(x, y, 1);
  Eigen::Vector3f c = centre, r = ray;
  const bool cylinder = surface->kind == Surface::Kind::kCylinder;
  if (cylinder) {
    c -= c.dot(axis) * axis;
    r -= r.dot(axis) * axis;
  }
  const float radius = static_cast<float>(surface->radius);
  const float a = r.squaredNorm(), b = r.dot(c);
  // b^2 - a (c^2 - radius^2), written so that float does not cancel.
  const float discriminant = a * radius * radius - r.cross(c).squaredNorm();
  if (a <= 0 || discriminant < 0) return 0;
  const float depth = (b - std::sqrt(discriminant)) / a;
  if (depth <= 0.01F) return 0;
  if (cylinder) {
    const float along = (depth * ray - centre).dot(axis);
    if (along < 0 || along > height) return 0;
  }
  return 1 / depth;
}

float PlacedSurface::ShadeCurved(float x, float y, float inverse_depth) const {
  const float depth = 1 / inverse_depth;
  const Eigen::Vector3f local = R_map_camera * (depth * Eigen::Vector3f(x, y, 1) - centre);
  const Texture& texture = *surface->texture;
  const bool sphere = surface->kind == Surface::Kind::kSphere;
  Eigen::Vector3f normal = local;
  const float radius = static_cast<float>(surface->radius);
  const float turn = std::atan2(local.y(), local.x()) / static_cast<float>(2 * kPi) + 0.5F;
  float v = 0;
  if (sphere) {
    v = std::acos(std::clamp(local.z() / radius, -1.0F, 1.0F)) / static_cast<float>(kPi);
  } else {
    const Eigen::Vector3f up = R_map_camera * axis;
    normal -= normal.dot(up) * up;
    v = 1 - local.dot(up) / height;
  }
  // Towards the contour more texture falls into a pixel.
  const Eigen::Vector3f view = R_map_camera * Eigen::Vector3f(x, y, 1).normalized();
  const float slope = std::max(0.15F, -view.dot(normal.normalized()));
  const float lod = lod_offset + ApproximateLog2(depth) - 0.6F * ApproximateLog2(slope);
  const float light = LightOn(normal.normalized().cast<double>());
  return light * texture.Sample(turn * static_cast<float>(texture.width()),
                                v * static_cast<float>(texture.height()), lod);
}

}  // namespace evit::simulation
