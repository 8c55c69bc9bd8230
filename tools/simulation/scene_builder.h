#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tools/simulation/random.h"
#include "tools/simulation/scene.h"
#include "tools/simulation/texture_painter.h"

namespace evit::simulation {

/// Puts textured pieces into a scene, with seeded random choices.
class SceneBuilder {
 public:
  /// `plain`: surfaces have one grey each, or a smooth gradient, whatever is asked for.
  explicit SceneBuilder(std::uint64_t seed, std::uint64_t stream, bool plain = false)
      : random_(seed, stream), plain_(plain) {}

  Random& random() { return random_; }
  bool plain() const { return plain_; }

  /// `base`: grey of the surface's material.
  void Rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_s, const Eigen::Vector3d& edge_t,
                 Paint paint, double base, double texel = 0.003) {
    Surface s;
    s.origin = origin;
    s.edge_s = edge_s;
    s.edge_t = edge_t;
    s.normal = edge_t.cross(edge_s).normalized();
    s.gain = LightOn(s.normal);
    s.texture = Picture(edge_s.norm(), edge_t.norm(), paint, base, texel);
    scene_.surfaces.push_back(s);
  }

  /// A box standing on z = base.z, turned by `yaw`; its four sides and top (and bottom, where it hangs).
  void Box(const Eigen::Vector3d& centre_below, const Eigen::Vector3d& size, double yaw, Paint paint,
           double base) {
    const Eigen::Vector3d x = Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0) * size.x();
    const Eigen::Vector3d y = Eigen::Vector3d(-std::sin(yaw), std::cos(yaw), 0) * size.y();
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ() * size.z(), o = centre_below - 0.5 * x - 0.5 * y;
    Rectangle(o + z, x, -z, paint, base);           // faces -y
    Rectangle(o + x + z, y, -z, paint, base);       // faces +x
    Rectangle(o + x + y + z, -x, -z, paint, base);  // faces +y
    Rectangle(o + y + z, -y, -z, paint, base);      // faces -x
    Rectangle(o + y + z, x, -y, paint, base);       // top
    if (o.z() > 0.02) Rectangle(o, x, y, Paint::kPlain, base);
  }

  void Cylinder(const Eigen::Vector3d& base_centre, double radius, double height, Paint paint, double base) {
    Surface s;
    s.kind = Surface::Kind::kCylinder;
    s.origin = base_centre;
    s.edge_t = Eigen::Vector3d(0, 0, height);
    s.radius = radius;
    s.texture = Picture(6.2832 * radius, height, paint, base, 0.003);
    scene_.surfaces.push_back(s);
    Rectangle(base_centre + Eigen::Vector3d(-radius, radius, height), Eigen::Vector3d(2 * radius, 0, 0),
              Eigen::Vector3d(0, -2 * radius, 0), Paint::kPlain, std::min(240.0, base * 1.2));
    scene_.surfaces.back().kind = Surface::Kind::kDisc;
  }

  void Sphere(const Eigen::Vector3d& centre, double radius, Paint paint, double base) {
    Surface s;
    s.kind = Surface::Kind::kSphere;
    s.origin = centre;
    s.radius = radius;
    s.texture = Picture(6.2832 * radius, 3.1416 * radius, paint, base, 0.004);
    scene_.surfaces.push_back(s);
  }

  double Grey(double low, double high) { return random_.Uniform(low, high); }

  Paint BusyPaint() {
    constexpr std::array<Paint, 6> kinds{Paint::kShapes,  Paint::kText,    Paint::kPhoto,
                                         Paint::kChecker, Paint::kStripes, Paint::kShapes};
    return kinds[random_.Integer(0, static_cast<int>(kinds.size()) - 1)];
  }
  Paint CalmPaint() {
    constexpr std::array<Paint, 4> kinds{Paint::kPlain, Paint::kGradient, Paint::kWood, Paint::kPlain};
    return kinds[random_.Integer(0, static_cast<int>(kinds.size()) - 1)];
  }
  Paint AnyPaint(double busy) { return random_.Chance(busy) ? BusyPaint() : CalmPaint(); }

  Scene Take() { return std::move(scene_); }
  Scene& scene() { return scene_; }

 private:
  const Texture* Picture(double width, double height, Paint paint, double base, double texel) {
    if (plain_ && paint != Paint::kGradient) paint = Paint::kPlain;
    if (paint == Paint::kPlain) texel = std::max(width, height) / 4;
    if (paint == Paint::kGradient) texel = 0.02;
    const int w = std::max(2, static_cast<int>(std::lround(width / texel)));
    const int h = std::max(2, static_cast<int>(std::lround(height / texel)));
    scene_.textures.emplace_back(PaintPicture(paint, w, h, texel, base, &random_),
                                 static_cast<float>(width / w),
                                 paint == Paint::kPlain || paint == Paint::kGradient);
    return &scene_.textures.back();
  }

  Random random_;
  bool plain_;
  Scene scene_;
};

}  // namespace evit::simulation
