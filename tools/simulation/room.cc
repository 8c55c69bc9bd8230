#include "tools/simulation/room.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/simulation/scene_builder.h"

namespace evit::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kHalfX = 2.6, kHalfY = 2.5, kHeight = 2.8;

void AddShell(SceneBuilder* b) {
  const double wall = b->Grey(140, 200);
  const Vector3d x(2 * kHalfX, 0, 0), y(0, 2 * kHalfY, 0), z(0, 0, kHeight);
  const Vector3d o(-kHalfX, -kHalfY, 0);
  b->Rectangle(o + x + y + z, -y, -z, Paint::kGradient, wall);                 // x = +, seen from inside
  b->Rectangle(o + z, y, -z, Paint::kGradient, wall);                          // x = -
  b->Rectangle(o + y + z, x, -z, Paint::kGradient, wall + b->Grey(-20, 20));   // y = +
  b->Rectangle(o + x + z, -x, -z, Paint::kGradient, wall + b->Grey(-20, 20));  // y = -
  b->Rectangle(o + y, x, -y, b->random().Chance(0.5) ? Paint::kTiles : Paint::kWood, b->Grey(90, 150), 0.004);
  b->Rectangle(o + z, x, y, Paint::kTiles, b->Grey(170, 215), 0.004);
}

// Posters, pictures and doors on a wall of which `origin` is the top left corner seen from inside.
void AddPosters(SceneBuilder* b, const Vector3d& origin, const Vector3d& along, double length, int n) {
  if (b->plain()) return;
  const Vector3d inward = Vector3d(0, 0, -1).cross(along);
  double place = b->Grey(0.1, 0.3);
  for (int i = 0; i < n && place < length - 0.4; ++i) {
    const double width = std::min(b->Grey(0.4, 1.0), length - place - 0.05), height = b->Grey(0.4, 1.1);
    const double drop = b->Grey(0.35, 1.5 - 0.5 * height);
    const Vector3d corner = origin + place * along - Vector3d(0, 0, drop) + 0.012 * inward;
    b->Rectangle(corner, width * along, Vector3d(0, 0, -height), b->BusyPaint(), b->Grey(50, 230));
    place += width + b->Grey(0.08, 0.45);
  }
}

// Returns the middle of its top.
Vector3d AddTable(SceneBuilder* b, const Vector3d& at, double yaw) {
  const double width = b->Grey(0.5, 0.8), length = b->Grey(0.9, 1.4), height = b->Grey(0.5, 0.78);
  const double grey = b->Grey(60, 220);
  b->Box(at + Vector3d(0, 0, height - 0.04), {width, length, 0.04}, yaw, Paint::kWood, grey);
  const auto turned = [&](double x, double y) -> Vector3d {
    return at + Vector3d(std::cos(yaw) * x - std::sin(yaw) * y, std::sin(yaw) * x + std::cos(yaw) * y, 0);
  };
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      b->Box(turned(x * (width / 2 - 0.05), y * (length / 2 - 0.05)), {0.06, 0.06, height - 0.04}, yaw,
             Paint::kPlain, grey * 0.7);
    }
  }
  const int n = b->plain() ? 2 : b->random().Integer(3, 5);
  for (int i = 0; i < n; ++i) {
    const Vector3d p = turned(b->Grey(-width / 3, width / 3), (i + 0.5 - 0.5 * n) * length / n * 0.85) +
                       Vector3d(0, 0, height);
    const int kind = b->random().Integer(0, 4);
    if (kind == 0) {
      const double radius = b->Grey(0.06, 0.11);
      b->Sphere(p + Vector3d(0, 0, radius), radius, b->AnyPaint(0.6), b->Grey(60, 220));
    } else if (kind == 1) {
      b->Cylinder(p, b->Grey(0.04, 0.08), b->Grey(0.1, 0.3), b->AnyPaint(0.7), b->Grey(60, 220));
    } else {
      b->Box(p, {b->Grey(0.08, 0.25), b->Grey(0.08, 0.22), b->Grey(0.06, 0.35)}, b->Grey(0, 3.1),
             b->AnyPaint(0.6), b->Grey(40, 230));
    }
  }
  return at + Vector3d(0, 0, height);
}

// Shelf open to -x (before yaw): back, sides, boards, books and boxes on them.
void AddShelf(SceneBuilder* b, const Vector3d& at, double yaw) {
  const double width = b->Grey(0.8, 1.3), height = b->Grey(1.3, 2.1), depth = 0.32;
  const double grey = b->Grey(60, 220);
  const int boards = b->random().Integer(3, 5);
  const auto turned = [&](double x, double y, double z) -> Vector3d {
    return at + Vector3d(std::cos(yaw) * x - std::sin(yaw) * y, std::sin(yaw) * x + std::cos(yaw) * y, z);
  };
  b->Box(turned(depth / 2 - 0.01, 0, 0), {0.02, width, height}, yaw, Paint::kPlain, grey * 0.8);
  for (const double side : {-1.0, 1.0}) {
    b->Box(turned(0, side * (width / 2 - 0.015), 0), {depth, 0.03, height}, yaw, Paint::kPlain, grey);
  }
  for (int i = 0; i < boards; ++i) {
    const double z = height * i / boards + 0.03;
    b->Box(turned(0, 0, z), {depth, width - 0.06, 0.03}, yaw, Paint::kPlain, grey);
    double y = -width / 2 + 0.06;
    while (y < width / 2 - 0.2) {
      const double thick = b->random().Chance(0.6) ? b->Grey(0.03, 0.07) : b->Grey(0.1, 0.2);
      const double tall = b->Grey(0.4, 0.85) * (height / boards - 0.06);
      if (b->random().Chance(b->plain() ? 0.15 : 0.75)) {
        b->Box(turned(b->Grey(-0.04, 0.02), y + thick / 2, z + 0.03), {0.22, thick, tall}, yaw,
               thick > 0.09 ? b->AnyPaint(0.6) : Paint::kPlain, b->Grey(30, 230));
      }
      y += thick + (b->random().Chance(0.3) ? b->Grey(0.02, 0.12) : 0.004);
    }
  }
}

// Sofa looking to -x (before yaw).
void AddSofa(SceneBuilder* b, const Vector3d& at, double yaw) {
  const double length = b->Grey(1.2, 1.7), grey = b->Grey(50, 200);
  const Paint cloth = b->AnyPaint(0.3);
  const auto turned = [&](double x, double y, double z) -> Vector3d {
    return at + Vector3d(std::cos(yaw) * x - std::sin(yaw) * y, std::sin(yaw) * x + std::cos(yaw) * y, z);
  };
  b->Box(turned(0, 0, 0), {0.7, length, 0.42}, yaw, cloth, grey);
  b->Box(turned(0.3, 0, 0.42), {0.16, length, 0.42}, yaw, cloth, grey * 0.9);
  for (const double side : {-1.0, 1.0}) {
    b->Box(turned(0, side * (length / 2 + 0.08), 0), {0.7, 0.16, 0.6}, yaw, cloth, grey * 0.8);
  }
  for (int i = 0; i < 3; ++i) {
    b->Box(turned(0.12, (i - 1) * length * 0.3, 0.42), {0.12, 0.36, b->Grey(0.3, 0.4)},
           yaw + b->Grey(-0.3, 0.3), b->BusyPaint(), b->Grey(60, 220));
  }
}

}  // namespace

Scene MakeRoom(std::uint64_t seed, RoomKind kind) {
  SceneBuilder b(seed, 0x5CE7E, kind == RoomKind::kPlain);
  b.scene().free_space = Eigen::AlignedBox3d(Vector3d(-1.5, -1.2, 0.8), Vector3d(0.5, 1.2, 2.1));
  AddShell(&b);
  AddPosters(&b, {kHalfX, kHalfY, kHeight}, {0, -1, 0}, 2 * kHalfY, 5);
  AddPosters(&b, {-kHalfX, kHalfY, kHeight}, {1, 0, 0}, 2 * kHalfX, 4);
  AddPosters(&b, {kHalfX, -kHalfY, kHeight}, {-1, 0, 0}, 2 * kHalfX, 4);
  AddPosters(&b, {-kHalfX, -kHalfY, kHeight}, {0, 1, 0}, 2 * kHalfY, 3);
  // Three places along +x, one piece each in random order; then the sides and the back.
  std::array<int, 3> order{0, 1, 2};
  for (int i = 2; i > 0; --i) std::swap(order[i], order[b.random().Integer(0, i)]);
  for (int i = 0; i < 3; ++i) {
    const double y = (i - 1) * 1.55 + b.Grey(-0.1, 0.1), yaw = (i - 1) * 0.5 + b.Grey(-0.15, 0.15);
    if (order[i] == 0) AddSofa(&b, {b.Grey(1.6, 1.9), y, 0}, yaw);
    if (order[i] == 1) AddShelf(&b, {b.Grey(1.5, 2.0), y, 0}, yaw);
    if (order[i] == 2) AddTable(&b, {b.Grey(1.2, 1.5), y, 0}, yaw);
  }
  b.scene().desk = AddTable(&b, {b.Grey(-0.6, 0.2), 1.85, 0}, 1.57 + b.Grey(-0.1, 0.1));
  AddShelf(&b, {b.Grey(-0.6, 0.2), -2.1, 0}, -1.57 + b.Grey(-0.1, 0.1));
  AddSofa(&b, {-2.1, b.Grey(-0.4, 0.4), 0}, 3.14 + b.Grey(-0.1, 0.1));
  const int stack = b.random().Integer(2, 4);
  double z = 0;
  const double x = b.Grey(0.95, 1.1), y = b.Grey(-0.8, 0.8);
  for (int i = 0; i < stack; ++i) {
    const double height = b.Grey(0.15, 0.3);
    b.Box({x, y, z}, {b.Grey(0.25, 0.4), b.Grey(0.25, 0.4), height}, b.Grey(0, 1.5), b.AnyPaint(0.7),
          b.Grey(50, 220));
    z += height;
  }
  const double radius = b.Grey(0.12, 0.2);
  b.Sphere({x, y, z + radius}, radius, b.BusyPaint(), b.Grey(60, 220));
  b.Cylinder({b.Grey(1.9, 2.3), b.random().Chance(0.5) ? 0.8 : -0.8, 0}, b.Grey(0.08, 0.14), b.Grey(1.4, 2.4),
             b.AnyPaint(0.6), b.Grey(60, 220));
  // Lamps and boxes hanging from the ceiling keep edges in view when the camera looks up.
  for (int i = 0; i < 4; ++i) {
    b.Box({b.Grey(0.3, 2.2), (i - 1.5) * 1.1, kHeight - b.Grey(0.15, 0.3)},
          {b.Grey(0.3, 0.6), b.Grey(0.2, 0.5), 0.12}, b.Grey(0, 1.5), b.AnyPaint(0.4), b.Grey(80, 240));
  }
  return b.Take();
}

}  // namespace evit::simulation
