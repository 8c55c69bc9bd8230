#include "common/mapping/view_pose_fit.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/geometry/degrees.h"
#include "common/mapping/edge_sighting.h"

namespace evit {
namespace {

constexpr std::size_t kPoints = 2500;
constexpr double kAlike = 5;  // points on one edge err together: so many of them are worth one
constexpr int kIterations = 2;

// Every n-th will do for six unknowns.
std::vector<std::int32_t> ThinnedOut(std::vector<std::int32_t> ids) {
  const std::size_t stride = 1 + ids.size() / kPoints;
  for (std::size_t k = 0; k * stride < ids.size(); ++k) ids[k] = ids[k * stride];
  ids.resize((ids.size() + stride - 1) / stride);
  return ids;
}

struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

// Of the points' distances to their edges, by a right-hand perturbation of the pose: a point of the camera
// frame moves by -R^T dp + p x dtheta.
NormalEquations OfEdges(const PosedEdges& view, const std::vector<MappedPoint>& points,
                        const std::vector<std::int32_t>& ids, double radius, double edge_sigma_px) {
  const PinholeView pinhole(view.T_map_camera, view.camera);
  NormalEquations sum;
  for (const std::int32_t id : ids) {
    const Eigen::Vector3d p = pinhole.InCamera(points[id].position);
    if (p.z() < kNearestPoint) continue;
    const std::optional<EdgeSighting> sighting = SightEdge(pinhole, view, points[id], p, radius);
    if (!sighting || !sighting->found) continue;
    Eigen::Matrix<double, 1, 6> j;
    j << -sighting->by_point * pinhole.R, sighting->by_point * Hat(p);
    const double w = sighting->Weight(edge_sigma_px);
    sum.information += w * j.transpose() * j;
    sum.gradient += w * sighting->off * j.transpose();
  }
  sum.information /= kAlike;
  sum.gradient /= kAlike;
  return sum;
}

void AddPrior(const SE3& pose, const SE3& given, const EdgeAdjustmentOptions& options, NormalEquations* sum) {
  const double per_m2 = 1 / (options.pose_sigma_m * options.pose_sigma_m);
  const double per_rad2 = 1 / std::pow(options.pose_sigma_deg * kRadiansPerDegree, 2);
  Vector6d off, prior;
  off << pose.p - given.p, LogSO3(given.q.conjugate() * pose.q);
  prior << per_m2, per_m2, per_m2, per_rad2, per_rad2, per_rad2;
  sum->information.diagonal() += prior;
  sum->gradient += prior.cwiseProduct(off);
}

}  // namespace

void FitViewPose(const std::vector<MappedPoint>& points, double radius, const SE3& given,
                 const EdgeAdjustmentOptions& options, PosedEdges* view) {
  const std::vector<std::int32_t> ids = ThinnedOut(VisiblePoints(*view, points));
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    NormalEquations sum = OfEdges(*view, points, ids, radius, options.edge_sigma_px);
    AddPrior(view->T_map_camera, given, options, &sum);
    const Vector6d step = -sum.information.ldlt().solve(sum.gradient);
    if (!step.allFinite()) return;
    view->T_map_camera = view->T_map_camera.Plus(step);
  }
}

}  // namespace evit
