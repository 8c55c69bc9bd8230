#include "tools/simulation/screen_span.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evit::simulation {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;

// Keeps the part where side . p >= offset.
Polygon Clip(const Polygon& polygon, const Eigen::Vector3d& side, double offset) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = side.dot(a) - offset, db = side.dot(b) - offset;
    if (da >= 0) out.push_back(a);
    if ((da >= 0) != (db >= 0)) out.push_back(a + da / (da - db) * (b - a));
  }
  return out;
}

struct Spans {
  const Camera& camera;
  std::vector<std::int16_t>*begin, *end;
  int first_row, last_row;

  void Reset() {
    begin->assign(camera.height, static_cast<std::int16_t>(camera.width));
    end->assign(camera.height, 0);
    first_row = camera.height;
    last_row = -1;
  }
  // Also records parts left or right of the image: the span is the hull of an outline's pieces.
  void Cover(int y, double x0, double x1) {
    const int b = static_cast<int>(std::clamp(std::floor(x0) - 1, 0.0, double(camera.width)));
    const int e = static_cast<int>(std::clamp(std::ceil(x1) + 2, 0.0, double(camera.width)));
    (*begin)[y] = static_cast<std::int16_t>(std::min<int>((*begin)[y], b));
    (*end)[y] = static_cast<std::int16_t>(std::max<int>((*end)[y], e));
    first_row = std::min(first_row, y);
    last_row = std::max(last_row, y);
  }
  void CoverAll() {
    for (int y = 0; y < camera.height; ++y) Cover(y, 0, camera.width - 1);
  }
  void CoverSegment(Eigen::Vector2d a, Eigen::Vector2d b) {
    if (a.y() > b.y()) std::swap(a, b);
    const int y0 = static_cast<int>(std::max(0.0, std::floor(a.y()) - 1));
    const int y1 = static_cast<int>(std::min(camera.height - 1.0, std::ceil(b.y()) + 1));
    const double slope = (b.x() - a.x()) / std::max(1e-9, b.y() - a.y());
    for (int y = y0; y <= y1; ++y) {
      const double u = a.x() + slope * (std::clamp(y - 1.0, a.y(), b.y()) - a.y());
      const double v = a.x() + slope * (std::clamp(y + 1.0, a.y(), b.y()) - a.y());
      Cover(y, std::min(u, v), std::max(u, v));
    }
  }
  bool done() const { return last_row >= first_row; }
};

// The convex outline in the camera frame: a rectangle's corners, or those of a curved surface's box.
Polygon Outline(const PlacedSurface& placed) {
  if (!placed.IsPlane()) return {};
  // Corners from the ray equations: u = (s . p) / (w . p), w . p == 1 on the plane.
  Eigen::Matrix3d m;
  m.row(0) = placed.s.cast<double>();
  m.row(1) = placed.t.cast<double>();
  m.row(2) = placed.w.cast<double>();
  const Eigen::Matrix3d inverse = m.inverse();
  Polygon corners;
  for (const auto& c : std::array<std::array<double, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}) {
    corners.push_back(inverse * Eigen::Vector3d(c[0], c[1], 1));
  }
  return corners;
}

// Bounding square of a ball in normalised coordinates; for a cylinder, of the balls around its ends.
bool CurvedSpans(const PlacedSurface& placed, Spans* spans) {
  const float radius = static_cast<float>(placed.surface->radius) * 1.02F;
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  for (const float along : {0.0F, placed.height}) {
    const Eigen::Vector3f c = placed.centre + along * placed.axis;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3f sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const Eigen::Vector3d p = (c + radius * sign).cast<double>();
      Eigen::Vector2d pixel;
      if (p.z() < 0.1 || !spans->camera.Project(p, &pixel)) {
        spans->CoverAll();
        return true;
      }
      x0 = std::min(x0, pixel.x()), x1 = std::max(x1, pixel.x());
      y0 = std::min(y0, pixel.y()), y1 = std::max(y1, pixel.y());
    }
  }
  const double bottom = std::min(spans->camera.height - 1.0, std::ceil(y1) + 2);
  for (int y = static_cast<int>(std::max(0.0, y0 - 2)); y <= bottom; ++y) spans->Cover(y, x0 - 2, x1 + 2);
  return spans->done();
}

bool Behind(const PlacedSurface& placed) {
  const float reach = static_cast<float>(placed.surface->radius);
  return placed.centre.z() < -reach && (placed.centre + placed.height * placed.axis).z() < -reach;
}

}  // namespace

bool FindScreenSpans(const Camera& camera, const double bound_x[2], const double bound_y[2],
                     const PlacedSurface& placed, std::vector<std::int16_t>* begin,
                     std::vector<std::int16_t>* end, int* first_row, int* last_row) {
  Spans spans{camera, begin, end, 0, 0};
  spans.Reset();
  bool seen = false;
  if (!placed.IsPlane()) {
    seen = !Behind(placed) && CurvedSpans(placed, &spans);
  } else {
    Polygon polygon = Clip(Outline(placed), {0, 0, 1}, 0.02);
    polygon = Clip(polygon, {1, 0, -bound_x[0]}, 0);
    polygon = Clip(polygon, {-1, 0, bound_x[1]}, 0);
    polygon = Clip(polygon, {0, 1, -bound_y[0]}, 0);
    polygon = Clip(polygon, {0, -1, bound_y[1]}, 0);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector3d a = polygon[i] / polygon[i].z();
      const Eigen::Vector3d b = polygon[(i + 1) % polygon.size()] / polygon[(i + 1) % polygon.size()].z();
      // Short pieces: between their ends the lens bends a straight line by less than the margin.
      const int pieces = 1 + static_cast<int>((b - a).norm() / 0.08);
      Eigen::Vector2d last, next;
      bool valid = camera.Project(a, &last);
      for (int k = 1; k <= pieces && valid; ++k) {
        valid = camera.Project(a + (b - a) * (static_cast<double>(k) / pieces), &next);
        if (valid) spans.CoverSegment(last, next);
        last = next;
      }
      if (!valid) {  // beyond the lens model's range: no bounds known
        spans.CoverAll();
        break;
      }
    }
    seen = spans.done();
  }
  *first_row = spans.first_row;
  *last_row = spans.last_row;
  return seen;
}

}  // namespace evit::simulation
