#include "common/mapping/depth_fusion.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

// The edges of a view that have a depth; the k-th edge has the k-th depth.
EdgeImage MeasuredEdges(const PosedEdges& view, const std::vector<EdgeDepth>& depths) {
  std::vector<EdgePixel> edges;
  edges.reserve(depths.size());
  for (const EdgeDepth& d : depths) edges.push_back(view.edges.edges()[d.edge]);
  return {view.edges.width(), view.edges.height(), std::move(edges), view.edges.has_sides()};
}

struct KeyView {
  PinholeView pinhole;
  EdgeImage measured;
  CameraSweep sweep;
};

// Adds what one key view says of a point at p of the map with normal direction `along` to the fused inverse
// depth in another; true where it agrees, `seen` where the point lies in its picture.
struct Witness {
  bool seen = false, agrees = false;
  double inverse_depth = 0, sigma = 0;  // along the ray to p
};

Witness Ask(const KeyView& key, const std::vector<EdgeDepth>& depths, const MappedPoint& point,
            double point_sigma, const DepthFusionOptions& options) {
  Witness witness;
  const Eigen::Vector3d p = key.pinhole.InCamera(point.position);
  if (p.z() < 0.05) return witness;
  const Eigen::Vector2d pixel = key.pinhole.Pixel(p);
  if (!key.pinhole.camera.Contains(pixel, 5)) return witness;
  const Eigen::Vector2d tangent = key.pinhole.Jacobian(p) * (key.pinhole.R * point.direction);
  EdgeImage::Query query;
  query.pixel = pixel.cast<float>();
  query.normal = Eigen::Vector2d(-tangent.y(), tangent.x()).normalized().cast<float>();
  witness.seen = key.sweep.Shows(key.pinhole.camera, p, query.normal);
  if (!witness.seen || tangent.norm() < 1e-9) return witness;
  query.radius = static_cast<float>(options.max_off_px);
  const EdgePixel* match = key.measured.Match(query);
  if (match == nullptr) return witness;
  const EdgeDepth& other = depths[match - key.measured.edges().data()];
  const double predicted = 1 / p.z();
  // `point_sigma` is relative.
  const double sigma = std::hypot(other.sigma, point_sigma * predicted);
  witness.agrees =
      std::abs(other.inverse_depth - predicted) < 3 * sigma + options.relative_tolerance * predicted;
  witness.inverse_depth = other.inverse_depth;
  witness.sigma = other.sigma;
  return witness;
}

MappedPoint PointOf(const PosedEdges& view, const EdgeDepth& depth) {
  const EdgePixel& edge = view.edges.edges()[depth.edge];
  const Camera& c = view.camera;
  const Eigen::Vector3d ray((edge.pixel.x() - c.cx) / c.fx, (edge.pixel.y() - c.cy) / c.fy, 1);
  const double w = depth.inverse_depth;
  // d(ray / w) for one pixel along the tangent.
  const Eigen::Vector3d along =
      Eigen::Vector3d(edge.normal.y() / c.fx, -edge.normal.x() / c.fy, 0) / w - ray * depth.slope / (w * w);
  MappedPoint point;
  point.position = view.T_map_camera * (ray / w);
  point.direction = (view.T_map_camera.q * along).normalized();
  point.sigma = depth.sigma / w / w;
  point.views = depth.views;
  point.contrast = edge.contrast;
  return point;
}

}  // namespace

void SmoothAlongEdges(const PosedEdges& view, const DepthFusionOptions& options,
                      std::vector<EdgeDepth>* depths) {
  const EdgeImage measured = MeasuredEdges(view, *depths);
  std::vector<EdgeDepth> kept;
  for (std::size_t k = 0; k < depths->size(); ++k) {
    const EdgeDepth& own = (*depths)[k];
    const EdgePixel& edge = measured.edges()[k];
    double s0 = 0, s1 = 0, s2 = 0, y0 = 0, y1 = 0;  // weighted moments along the edge
    int agree = 0;
    measured.VisitNear(edge.pixel, static_cast<float>(options.reach_px), [&](const EdgePixel& other) {
      const EdgeDepth& d = (*depths)[&other - measured.edges().data()];
      const Eigen::Vector2f off = other.pixel - edge.pixel;
      const double across = off.dot(edge.normal),
                   along = off.x() * edge.normal.y() - off.y() * edge.normal.x();
      const float cosine = other.normal.dot(edge.normal);
      if (std::abs(across) > 1.5 || std::abs(along) > options.reach_px ||
          (measured.has_sides() ? cosine : std::abs(cosine)) < 0.9F)
        return;
      if (std::abs(d.inverse_depth - own.inverse_depth) >
          3 * std::hypot(d.sigma, own.sigma) + 0.01 * own.inverse_depth)
        return;
      if (&d != &own) ++agree;
      const double w = 1 / (d.sigma * d.sigma);
      s0 += w, s1 += w * along, s2 += w * along * along;
      y0 += w * d.inverse_depth, y1 += w * along * d.inverse_depth;
    });
    if (agree < options.min_along) continue;
    EdgeDepth smooth = own;
    const double spread = s2 - s1 * s1 / s0;
    if (spread > s0) {  // a pixel squared
      smooth.slope = (y1 - s1 * y0 / s0) / spread;
      smooth.inverse_depth = (y0 - smooth.slope * s1) / s0;
    } else {
      smooth.inverse_depth = y0 / s0;
    }
    if (smooth.inverse_depth <= 0) continue;
    // Neighbours saw the same views with the same misplaced poses: no more than half the variance goes.
    smooth.sigma = own.sigma * std::sqrt(0.5);
    kept.push_back(smooth);
  }
  depths->swap(kept);
}

std::vector<MappedPoint> FuseDepths(const std::vector<PosedEdges>& views, const std::vector<KeyDepths>& keys,
                                    const DepthFusionOptions& options, int threads) {
  std::vector<KeyView> prepared;
  prepared.reserve(keys.size());
  for (const KeyDepths& key : keys) {
    const PosedEdges& view = views[key.view];
    prepared.push_back(
        {PinholeView(view.T_map_camera, view.camera), MeasuredEdges(view, key.depths), view.sweep});
  }
  std::vector<std::vector<MappedPoint>> parts(keys.size());
  ParallelFor(static_cast<int>(keys.size()), threads, [&](int k) {
    for (EdgeDepth depth : keys[k].depths) {
      const MappedPoint point = PointOf(views[keys[k].view], depth);
      const double relative = depth.sigma / depth.inverse_depth;
      int seen = 0, agree = 0;
      double sum = depth.inverse_depth / (depth.sigma * depth.sigma),
             weight = 1 / (depth.sigma * depth.sigma);
      for (std::size_t other = 0; other < keys.size(); ++other) {
        if (static_cast<int>(other) == k) continue;
        const Witness witness = Ask(prepared[other], keys[other].depths, point, relative, options);
        if (witness.seen) ++seen;
        if (!witness.agrees) continue;
        ++agree;
        // The other's depth on the same ray differs by the same share in both views, nearly.
        const double z = prepared[other].pinhole.InCamera(point.position).z();
        const double w = depth.inverse_depth * witness.inverse_depth * z;
        const double s = witness.sigma * z * depth.inverse_depth;
        sum += w / (s * s), weight += 1 / (s * s);
      }
      if (agree < std::max(options.least_keys, std::min(options.min_other_keys, seen))) continue;
      depth.inverse_depth = sum / weight;
      depth.sigma = 1 / std::sqrt(weight);
      MappedPoint fused = PointOf(views[keys[k].view], depth);
      fused.views = depth.views + agree;
      parts[k].push_back(fused);
    }
  });
  std::vector<MappedPoint> points;
  for (const auto& part : parts) points.insert(points.end(), part.begin(), part.end());
  return points;
}

}  // namespace evit
