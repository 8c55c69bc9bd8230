#include "common/mapping/edge_sighting.h"

#include <cmath>

#include "common/map/occlusion.h"

namespace evit {
namespace {

constexpr double kKernelPx = 0.7;
constexpr double kInlierPx = 1.0;
constexpr int kBorderPx = 6;
// Of an edge's length in the image when seen from the side: less, and it points at the camera.
constexpr double kShortest = 0.25;

}  // namespace

double EdgeSighting::Weight(double edge_sigma_px) const {
  return 1 / (1 + off * off / (kKernelPx * kKernelPx)) / (edge_sigma_px * edge_sigma_px);
}

bool EdgeSighting::Agrees() const { return found && std::abs(off) < kInlierPx; }

std::optional<EdgeSighting> SightEdge(const PinholeView& pinhole, const PosedEdges& view,
                                      const MappedPoint& point, const Eigen::Vector3d& p, double radius) {
  const Eigen::Matrix<double, 2, 3> jacobian = pinhole.Jacobian(p);
  const Eigen::Vector2d tangent = jacobian * (pinhole.R * point.direction);
  const double length = tangent.norm();
  if (length < kShortest * pinhole.camera.fx / p.z()) return {};
  EdgeImage::Query query;
  const Eigen::Vector2d pixel = pinhole.Pixel(p);
  query.pixel = pixel.cast<float>();
  query.normal = (Eigen::Vector2d(-tangent.y(), tangent.x()) / length).cast<float>();
  query.radius = static_cast<float>(radius);
  if (!view.sweep.Shows(pinhole.camera, p, query.normal)) return {};
  EdgeSighting sighting;
  if (const EdgePixel* match = view.edges.Match(query)) {
    const Eigen::RowVector2d normal = match->normal.cast<double>().transpose();
    sighting.found = true;
    sighting.way = view.sweep.Way(pinhole.camera, p, query.normal);
    sighting.off = normal * (pixel - match->pixel.cast<double>()) - point.lag * sighting.way;
    sighting.by_point = normal * jacobian;
  }
  return sighting;
}

std::vector<std::int32_t> VisiblePoints(const PosedEdges& view, const std::vector<MappedPoint>& points) {
  const PinholeView pinhole(view.T_map_camera, view.camera);
  std::vector<ProjectedPoint> projected;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d p = pinhole.InCamera(points[k].position);
    if (p.z() < kNearestPoint) continue;
    const Eigen::Vector2d pixel = pinhole.Pixel(p);
    if (!view.camera.Contains(pixel, kBorderPx)) continue;
    projected.push_back({static_cast<std::int32_t>(k), pixel.cast<float>(), static_cast<float>(p.z())});
  }
  RemoveOccluded(view.camera, 0, &projected);
  std::vector<std::int32_t> ids;
  ids.reserve(projected.size());
  for (const ProjectedPoint& p : projected) ids.push_back(p.id);
  return ids;
}

}  // namespace evit
