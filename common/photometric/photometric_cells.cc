#include "common/photometric/photometric_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/map/cell_order.h"

namespace evit {
namespace {

constexpr double kCell = 0.25;  // m

// From the number of points around some 100 of them. Distances to the nearest would be far too small: points
// of neighbouring voxels may lie close together.
float SpacingOf(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> spacings;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 100);
  for (float radius = 0.05F; radius < 10; radius *= 4) {
    spacings.clear();
    for (std::size_t k = 0; k < points.size(); k += stride) {
      int around = 0;
      for (const Eigen::Vector3f& p : points)
        around += (p - points[k]).squaredNorm() < radius * radius ? 1 : 0;
      spacings.push_back(radius * std::sqrt(3.1416F / static_cast<float>(around)));
    }
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::nth_element(spacings.begin(), middle, spacings.end());
    if (*middle < 0.5F * radius) return *middle;  // enough points for a figure
  }
  return spacings[spacings.size() / 2];
}

// A pinhole without distortion, in single precision.
struct Pinhole {
  explicit Pinhole(const ViewQuery& query)
      : R(query.T_map_camera.Inverse().R().cast<float>()),
        t(query.T_map_camera.Inverse().p.cast<float>()),
        fx(static_cast<float>(query.camera.fx)),
        fy(static_cast<float>(query.camera.fy)),
        cx(static_cast<float>(query.camera.cx)),
        cy(static_cast<float>(query.camera.cy)),
        right(static_cast<float>(query.camera.width)),
        bottom(static_cast<float>(query.camera.height)),
        near(static_cast<float>(query.min_depth)),
        far(static_cast<float>(query.max_depth)),
        sides{Eigen::Vector3f(fx, 0, cx + 1).normalized(), Eigen::Vector3f(-fx, 0, right - cx).normalized(),
              Eigen::Vector3f(0, fy, cy + 1).normalized(),
              Eigen::Vector3f(0, -fy, bottom - cy).normalized()} {}

  // Whether a ball about `center`, map frame, may be in view.
  bool MaySee(const Eigen::Vector3f& center, float radius) const {
    const Eigen::Vector3f c = R * center + t;
    if (c.z() < near - radius || c.z() > far + radius) return false;
    return std::none_of(sides.begin(), sides.end(),
                        [&](const Eigen::Vector3f& side) { return side.dot(c) < -radius; });
  }

  Eigen::Matrix3f R;  // camera from map
  Eigen::Vector3f t;
  float fx, fy, cx, cy, right, bottom, near, far;
  std::array<Eigen::Vector3f, 4> sides;  // of the pyramid in view, inward
};

EVIT_MULTIVERSION void ProjectCell(const Pinhole& view, const float* x, const float* y, const float* z,
                                   const float* intensity, std::size_t n, Splats* splats) {
  alignas(64) float u[kLanes], v[kLanes], depth[kLanes];
  alignas(64) int in_view[kLanes];
  const Eigen::Matrix3f& R = view.R;
  const float r00 = R(0, 0), r01 = R(0, 1), r02 = R(0, 2), r10 = R(1, 0), r11 = R(1, 1), r12 = R(1, 2);
  const float r20 = R(2, 0), r21 = R(2, 1), r22 = R(2, 2), tx = view.t[0], ty = view.t[1], tz = view.t[2];
  for (std::size_t k = 0; k < n; k += kLanes) {
    for (int l = 0; l < kLanes; ++l) {
      const float a = x[k + l], b = y[k + l], c = z[k + l];
      const float px = r00 * a + r01 * b + r02 * c + tx;
      const float py = r10 * a + r11 * b + r12 * c + ty;
      const float pz = r20 * a + r21 * b + r22 * c + tz;
      const int ahead =
          static_cast<int>(pz >= view.near) & static_cast<int>(pz <= view.far) & static_cast<int>(pz > 0);
      const float inverse = 1 / (ahead != 0 ? pz : 1);
      u[l] = view.fx * px * inverse + view.cx;
      v[l] = view.fy * py * inverse + view.cy;
      depth[l] = pz;
      in_view[l] = ahead & static_cast<int>(u[l] > -1) & static_cast<int>(v[l] > -1) &
                   static_cast<int>(u[l] < view.right) & static_cast<int>(v[l] < view.bottom);
    }
    const int lanes = n - k < kLanes ? static_cast<int>(n - k) : kLanes;
    splats->Append(u, v, depth, intensity + k, in_view, lanes);
  }
}

}  // namespace

PhotometricCells::PhotometricCells(const PhotometricMap& map) : n_(map.points.size()) {
  if (n_ == 0) return;
  spacing_ = SpacingOf(map.points);
  const CellOrder order(map.points, kCell);
  for (std::size_t begin = 0, end = 0; begin < n_; begin = end) {
    end = order.EndOfCell(begin);
    Eigen::Vector3f low = map.points[static_cast<std::size_t>(order[begin].index)], high = low;
    for (std::size_t k = begin; k < end; ++k) {
      const auto index = static_cast<std::size_t>(order[k].index);
      const Eigen::Vector3f& p = map.points[index];
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
      x_.push_back(p.x());
      y_.push_back(p.y());
      z_.push_back(p.z());
      intensity_.push_back(map.intensities[index]);
    }
    cells_.push_back({0.5F * (low + high), 0.5F * (high - low).norm(), begin, end});
  }
  for (std::vector<float>* v : {&x_, &y_, &z_, &intensity_}) v->resize(n_ + kLanes);
}

void PhotometricCells::Project(const ViewQuery& query, std::size_t part, std::size_t parts,
                               Splats* splats) const {
  const Pinhole view(query);
  splats->Clear();
  for (const Cell& cell : cells_) {
    if (cell.begin * parts / n_ != part || !view.MaySee(cell.center, cell.radius)) continue;
    const std::size_t n = cell.end - cell.begin;
    splats->Reserve(n);
    ProjectCell(view, x_.data() + cell.begin, y_.data() + cell.begin, z_.data() + cell.begin,
                intensity_.data() + cell.begin, n, splats);
  }
  splats->Pad();
}

}  // namespace evit
