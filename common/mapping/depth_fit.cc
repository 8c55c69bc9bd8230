#include "common/mapping/depth_fit.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr int kRounds = 5;
constexpr int kBorderPx = 4;
constexpr float kFirstRadiusPx = 2.5F, kRadiusPx = 1.8F;  // within which a neighbour's edge is looked for
constexpr double kInlierPx = 1.2;
constexpr double kKernelPx = 0.7;  // scale of the Cauchy kernel

// Normal equations of three unknowns: the inverse depth; by how much the key view's own edge is misplaced
// across (in units of sigma); and by how many pixels events come late.
struct Equations {
  double a = 0, b = 0, c = 1, ga = 0, gb = 0;  // of depth and own place, which has a prior
  double al = 0, bl = 0, l = 0, gl = 0;        // of the lag, with both
};

// The unknowns' steps, and what is known of the depth (m^2).
struct Solution {
  double move = 0, lag = 0, information = 0;
};

Solution Solve(Equations e) {
  // The lag first: without event views it is its prior's, and nothing changes.
  e.a -= e.al * e.al / e.l, e.b -= e.al * e.bl / e.l, e.c -= e.bl * e.bl / e.l;
  e.ga -= e.al * e.gl / e.l, e.gb -= e.bl * e.gl / e.l;
  Solution s;
  s.information = e.a - e.b * e.b / e.c;
  s.move = -(e.ga - e.b * e.gb / e.c) / s.information;
  const double own = -(e.gb + e.b * s.move) / e.c;
  // What is left of the distances is what the lag makes of them.
  s.lag = (e.gl + e.al * s.move + e.bl * own) / e.l;
  return s;
}

bool LooksAlike(const EdgePixel& edge, const EdgePixel& match, double tolerance) {
  return std::min(std::abs(match.dark - edge.dark), std::abs(match.bright - edge.bright)) <= tolerance;
}

// The neighbour's part in the fit, at its present inverse depth; true if the neighbour should show the edge.
bool AddNeighbour(const StereoNeighbour& n, const EdgePixel& edge, float radius,
                  const EdgeStereoOptions& options, Equations* e, DepthFit* fit) {
  if (!n.shows()) return false;
  const Eigen::Vector3d p = n.At(fit->inverse_depth);
  if (p.z() < 0.05) return false;
  const Camera& camera = n.view().camera;
  const Eigen::Vector2d pixel(camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy);
  if (!camera.Contains(pixel, kBorderPx)) return false;
  EdgeImage::Query query;
  query.pixel = pixel.cast<float>();
  query.normal = n.normal();
  query.radius = radius;
  const EdgeImage& edges = n.view().edges;
  const EdgePixel* match = edges.Match(query);
  if (match == nullptr || (edges.has_sides() && !LooksAlike(edge, *match, options.side_tolerance)))
    return true;
  const Eigen::Vector2d normal = match->normal.cast<double>();
  const double r = normal.dot(pixel - match->pixel.cast<double>()) / options.edge_sigma_px;
  const Eigen::Vector2d move = n.Move(p);
  const double j = normal.dot(move) / options.edge_sigma_px;
  const double scaled = r * options.edge_sigma_px / kKernelPx;
  const double w = 1 / (1 + scaled * scaled);
  // An edge along the epipolar line says nothing, however its direction is measured: what an error of it
  // seems to say is taken off again.
  const double seeming = options.normal_sigma * move.norm() / options.edge_sigma_px;
  e->a += w * (j * j - seeming * seeming), e->b += w * j, e->c += w;
  e->ga += w * j * r, e->gb += w * r;
  const double late = n.late() / options.edge_sigma_px;
  e->al += w * j * late, e->bl += w * late, e->l += w * late * late, e->gl += w * r * late;
  if (std::abs(r) * options.edge_sigma_px < kInlierPx) ++fit->views, fit->support += w;
  return true;
}

}  // namespace

DepthFit FitDepth(const EdgePixel& edge, const std::vector<StereoNeighbour>& neighbours, double inverse_depth,
                  double step, const EdgeStereoOptions& options) {
  const double per_lag2 = 1 / (options.lag_sigma_px * options.lag_sigma_px);
  DepthFit fit;
  fit.inverse_depth = inverse_depth;
  for (int round = 0; round < kRounds; ++round) {
    Equations equations;
    equations.l = per_lag2;
    fit.support = fit.views = 0;
    double visible = 0;
    for (const StereoNeighbour& n : neighbours)
      visible += AddNeighbour(n, edge, round == 0 ? kFirstRadiusPx : kRadiusPx, options, &equations, &fit);
    fit.share = visible > 0 ? fit.views / visible : 0;
    const Solution solution = Solve(equations);
    if (fit.views < options.min_views || solution.information <= 0) return {};
    fit.sigma = 1 / std::sqrt(solution.information);
    fit.lag = solution.lag;
    fit.lag_sigma = equations.l > 1.5 * per_lag2 ? 1 / std::sqrt(equations.l) : 0;
    fit.inverse_depth = std::clamp(fit.inverse_depth + std::clamp(solution.move, -2 * step, 2 * step),
                                   1 / options.max_depth_m, 1 / options.min_depth_m);
    if (round > 0 && std::abs(solution.move) < 0.02 * step) break;
  }
  return fit;
}

}  // namespace evit
