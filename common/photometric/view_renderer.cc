#include "common/photometric/view_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace evit {
namespace {

constexpr float kCell = 0.25F;                                 // m
constexpr float kNothing = std::numeric_limits<float>::max();  // depth of a pixel that sees nothing
constexpr float kSameShare = 0.03F, kSame = 0.01F;  // of the depth, and m: points this near are one surface
constexpr float kLargest = 12;                      // pixels: half of the largest patch

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

}  // namespace

Camera ViewCamera(const Camera& camera, double margin) {
  Camera view;
  view.width = camera.width / 2;
  view.height = camera.height / 2;
  const double scale = 1 / (1 + margin);
  const double x = 0.5 * (view.width - 1), y = 0.5 * (view.height - 1);
  view.fx = 0.5 * scale * camera.fx;
  view.fy = 0.5 * scale * camera.fy;
  view.cx = scale * (0.5 * (camera.cx - 0.5) - x) + x;
  view.cy = scale * (0.5 * (camera.cy - 0.5) - y) + y;
  return view;
}

ViewRenderer::ViewRenderer(const PhotometricMap& map, double dark) : dark_(static_cast<float>(dark)) {
  const std::size_t n = map.points.size();
  if (n == 0) return;
  spacing_ = SpacingOf(map.points);
  std::vector<std::array<std::int32_t, 3>> keys(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3f c = (map.points[k] / kCell).array().floor().max(-1e9F).min(1e9F);
    keys[k] = {static_cast<std::int32_t>(c.x()), static_cast<std::int32_t>(c.y()),
               static_cast<std::int32_t>(c.z())};
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  for (const std::size_t k : order) {
    x_.push_back(map.points[k].x());
    y_.push_back(map.points[k].y());
    z_.push_back(map.points[k].z());
    intensity_.push_back(map.intensities[k]);
  }
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin;
    Eigen::Vector3f low(x_[begin], y_[begin], z_[begin]), high = low;
    for (; end < n && keys[order[end]] == keys[order[begin]]; ++end) {
      const Eigen::Vector3f p(x_[end], y_[end], z_[end]);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    cells_.push_back({0.5F * (low + high), 0.5F * (high - low).norm(), begin, end});
    begin = end;
  }
}

void ViewRenderer::Render(const ViewQuery& query, PhotometricView* view) {
  const std::size_t n = static_cast<std::size_t>(query.camera.width) * query.camera.height;
  view->query = query;
  view->log_intensity.assign(n, 0);
  view->inverse_depth.assign(n, 0);
  Project(query);
  FillDepth(query.camera);
  CloseLeaks(query.camera.width, query.camera.height);
  Blend(query.camera, view);
  FillHoles(query.camera, view);
}

// Points in view, a pixel around the image included.
void ViewRenderer::Project(const ViewQuery& query) {
  const Camera& camera = query.camera;
  const SE3 T = query.T_map_camera.Inverse();
  const Eigen::Matrix3f R = T.R().cast<float>();
  const Eigen::Vector3f t = T.p.cast<float>();
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  const float right = static_cast<float>(camera.width), bottom = static_cast<float>(camera.height);
  const auto near = static_cast<float>(query.min_depth), far = static_cast<float>(query.max_depth);
  const std::array<Eigen::Vector3f, 4> sides{
      Eigen::Vector3f(fx, 0, cx + 1).normalized(), Eigen::Vector3f(-fx, 0, right - cx).normalized(),
      Eigen::Vector3f(0, fy, cy + 1).normalized(), Eigen::Vector3f(0, -fy, bottom - cy).normalized()};
  splats_.clear();
  for (const Cell& cell : cells_) {
    const Eigen::Vector3f c = R * cell.center + t;
    if (c.z() < near - cell.radius || c.z() > far + cell.radius) continue;
    bool outside = false;
    for (const Eigen::Vector3f& side : sides) outside = outside || side.dot(c) < -cell.radius;
    if (outside) continue;
    for (std::size_t k = cell.begin; k < cell.end; ++k) {
      const Eigen::Vector3f p = R * Eigen::Vector3f(x_[k], y_[k], z_[k]) + t;
      if (!(p.z() >= near && p.z() <= far)) continue;
      const float inverse = 1 / p.z();
      const float x = fx * p.x() * inverse + cx, y = fy * p.y() * inverse + cy;
      if (x > -1 && y > -1 && x < right && y < bottom) splats_.push_back({x, y, p.z(), intensity_[k]});
    }
  }
}

// Nearest patch of each pixel.
void ViewRenderer::FillDepth(const Camera& camera) {
  const int width = camera.width, height = camera.height;
  depth_.assign(static_cast<std::size_t>(width) * height, kNothing);
  const float patch = 0.75F * spacing_ * static_cast<float>(std::max(camera.fx, camera.fy));
  for (const Splat& s : splats_) {
    const float half = std::clamp(patch / s.depth, 0.5F, kLargest);
    const int x0 = std::max(0, static_cast<int>(std::ceil(s.x - half)));
    const int y0 = std::max(0, static_cast<int>(std::ceil(s.y - half)));
    const int x1 = std::min(width - 1, static_cast<int>(std::floor(s.x + half)));
    const int y1 = std::min(height - 1, static_cast<int>(std::floor(s.y + half)));
    for (int y = y0; y <= y1; ++y) {
      float* const row = depth_.data() + static_cast<std::size_t>(y) * width;
      for (int x = x0; x <= x1; ++x) row[x] = std::min(row[x], s.depth);
    }
  }
}

// A pixel amid a nearer surface, at least six of its eight neighbours, is a gap between that surface's
// points.
void ViewRenderer::CloseLeaks(int width, int height) {
  scratch_ = depth_;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const std::size_t k = static_cast<std::size_t>(y) * width + x;
      const float limit = scratch_[k] == kNothing ? kNothing : scratch_[k] * (1 - 2 * kSameShare) - kSame;
      int nearer = 0;
      float farthest = 0;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u) {
          const float other = scratch_[k + static_cast<std::ptrdiff_t>(v) * width + u];
          if (other >= limit) continue;
          ++nearer;
          farthest = std::max(farthest, other);
        }
      }
      if (nearer >= 6) depth_[k] = farthest;
    }
  }
}

// Weighted mean of the points on the surface that each pixel sees.
void ViewRenderer::Blend(const Camera& camera, PhotometricView* view) {
  const int width = camera.width, height = camera.height;
  const std::size_t n = depth_.size();
  weight_.assign(n, 0);
  mean_.assign(n, 0);
  inverse_.assign(n, 0);
  const float reach = 1.2F * spacing_ * static_cast<float>(std::max(camera.fx, camera.fy));
  for (const Splat& s : splats_) {
    const float inverse = 1 / s.depth;
    const float radius = std::clamp(reach * inverse, 1.0F, kLargest), per_radius = 1 / radius;
    const int x0 = std::max(0, static_cast<int>(std::ceil(s.x - radius)));
    const int y0 = std::max(0, static_cast<int>(std::ceil(s.y - radius)));
    const int x1 = std::min(width - 1, static_cast<int>(std::floor(s.x + radius)));
    const int y1 = std::min(height - 1, static_cast<int>(std::floor(s.y + radius)));
    for (int y = y0; y <= y1; ++y) {
      const float wy = 1 - std::abs(static_cast<float>(y) - s.y) * per_radius;
      const std::size_t row = static_cast<std::size_t>(y) * width;
      for (int x = x0; x <= x1; ++x) {
        const float seen = depth_[row + x];
        if (std::abs(s.depth - seen) > kSameShare * s.depth + kSame) continue;
        const float w = wy * (1 - std::abs(static_cast<float>(x) - s.x) * per_radius);
        weight_[row + x] += w;
        mean_[row + x] += w * s.intensity;
        inverse_[row + x] += w * inverse;
      }
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (!(weight_[k] > 1e-3F)) continue;
    view->log_intensity[k] = std::log(mean_[k] / weight_[k] + dark_);
    view->inverse_depth[k] = inverse_[k] / weight_[k];
  }
}

// Twice: pixels that see nothing amid at least five that do get their mean.
void ViewRenderer::FillHoles(const Camera& camera, PhotometricView* view) {
  const int width = camera.width, height = camera.height;
  for (int round = 0; round < 2; ++round) {
    scratch_ = view->inverse_depth;
    for (int y = 1; y + 1 < height; ++y) {
      for (int x = 1; x + 1 < width; ++x) {
        const std::size_t k = static_cast<std::size_t>(y) * width + x;
        if (scratch_[k] > 0) continue;
        int seen = 0;
        float mean = 0, inverse = 0;
        for (int v = -1; v <= 1; ++v) {
          for (int u = -1; u <= 1; ++u) {
            const std::size_t j = k + static_cast<std::ptrdiff_t>(v) * width + u;
            if (!(scratch_[j] > 0)) continue;
            ++seen;
            mean += view->log_intensity[j];
            inverse += view->inverse_depth[j];
          }
        }
        if (seen < 5) continue;
        view->log_intensity[k] = mean / static_cast<float>(seen);
        view->inverse_depth[k] = inverse / static_cast<float>(seen);
      }
    }
  }
}

}  // namespace evit
