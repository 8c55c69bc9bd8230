#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "tools/simulation/four_values.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// log2 with an error below 0.01, continuous: enough to choose a mip level.
inline float ApproximateLog2(float x) {
  union {
    float f;
    std::uint32_t i;
  } bits{x};
  const float exponent = static_cast<float>(static_cast<int>(bits.i >> 23) - 127);
  bits.i = (bits.i & 0x7FFFFFU) | 0x3F800000U;
  const float m = bits.f - 1;
  return exponent + m * (1.3465F - 0.3465F * m);
}

inline Floats ApproximateLog2(Floats x) {
  const Ints bits = reinterpret_cast<Ints>(x);
  const Floats exponent = __builtin_convertvector((bits >> 23) - 127, Floats);
  const Floats m = reinterpret_cast<Floats>((bits & 0x7FFFFF) | 0x3F800000) - 1;
  return exponent + m * (1.3465F - 0.3465F * m);
}

/// A surface as one view sees it, in the camera frame. With ray r = (x, y, 1), the inverse depth of a plane
/// and its texture coordinates times inverse depth are linear in r: no division per pixel.
struct PlacedSurface {
  const Surface* surface = nullptr;
  std::int32_t index = 0;
  Eigen::Vector3f w;             // plane: inverse depth = w . r
  Eigen::Vector3f s, t;          // plane: (s . r) / (w . r) is 0..1 across the surface
  Eigen::Vector3f centre, axis;  // curved: in camera frame (axis: unit)
  float height = 0;
  float lod_offset = 0;  // texture level = lod_offset + 1.6 * log2(depth) (plane) or + log2(depth) (curved)
  Eigen::Matrix3f R_map_camera;  // curved: to shade in the map frame

  bool IsPlane() const {
    return surface->kind == Surface::Kind::kRectangle || surface->kind == Surface::Kind::kDisc;
  }

  /// Inverse depth where ray (x, y, 1) meets the surface; 0 where it does not.
  float Meet(float x, float y) const {
    if (!IsPlane()) return MeetCurved(x, y);
    const float iw = w.x() * x + w.y() * y + w.z();
    const float u = s.x() * x + s.y() * y + s.z(), v = t.x() * x + t.y() * y + t.z();
    if (!(iw > 0 && u >= 0 && u <= iw && v >= 0 && v <= iw)) return 0;
    if (surface->kind == Surface::Kind::kDisc) {
      const float a = u - 0.5F * iw, b = v - 0.5F * iw;
      if (a * a + b * b > 0.25F * iw * iw) return 0;
    }
    return iw;
  }

  float MeetCurved(float x, float y) const;

  /// Light that comes along ray (x, y, 1) from the surface, given its inverse depth there.
  float Shade(float x, float y, float inverse_depth) const {
    if (!IsPlane()) return ShadeCurved(x, y, inverse_depth);
    const Texture& texture = *surface->texture;
    const float z = 1 / inverse_depth;
    const float u = (s.x() * x + s.y() * y + s.z()) * z, v = (t.x() * x + t.y() * y + t.z()) * z;
    return surface->gain * texture.Sample(u * static_cast<float>(texture.width()),
                                          v * static_cast<float>(texture.height()),
                                          lod_offset + 1.6F * ApproximateLog2(z));
  }

  float ShadeCurved(float x, float y, float inverse_depth) const;
};

/// A surface seen from T_map_camera. False where its front cannot be seen from there.
bool PlaceSurface(const Surface& surface, std::int32_t index, const Eigen::Matrix3d& R_map_camera,
                  const Eigen::Vector3d& p_map_camera, double focal, PlacedSurface* placed);

}  // namespace evit::simulation
