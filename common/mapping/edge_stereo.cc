#include "common/mapping/edge_stereo.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/mapping/depth_fit.h"
#include "common/mapping/depth_votes.h"
#include "common/mapping/stereo_neighbour.h"

namespace evit {
namespace {

// Of the share that a depth takes in the end: votes are coarse.
constexpr float kCoarse = 0.6F;

double Evidence(const DepthFit& fit) { return fit.support * fit.share; }

bool SamePlace(const DepthFit& a, const DepthFit& b, double step) {
  return std::abs(a.inverse_depth - b.inverse_depth) < std::max(2 * step, 2 * std::max(a.sigma, b.sigma));
}

}  // namespace

std::optional<DepthFit> EdgeStereo::BestFit(const EdgePixel& edge,
                                            const std::vector<StereoNeighbour>& neighbours,
                                            const DepthSteps& steps, DepthVotes* votes) const {
  votes->Clear();
  for (const StereoNeighbour& n : neighbours) {
    if (n.shows()) votes->Add(n);
  }
  DepthFit best, rival;
  for (const auto& [share, inverse_depth] :
       votes->Peaks(options_.min_views, kCoarse * static_cast<float>(options_.min_share))) {
    if (share <= 0) break;
    const DepthFit fit = FitDepth(edge, neighbours, inverse_depth, steps.step, options_);
    if (fit.views <= 0) continue;
    if (best.views > 0 && SamePlace(fit, best, steps.step)) {
      if (fit.support > best.support) best = fit;
    } else if (Evidence(fit) > Evidence(best)) {
      rival = best, best = fit;
    } else if (Evidence(fit) > Evidence(rival)) {
      rival = fit;
    }
  }
  if (best.views < options_.min_views || best.share < options_.min_share) return {};
  if (Evidence(rival) > options_.max_rival_share * best.support * best.share) return {};
  if (best.sigma > options_.max_relative_sigma * best.inverse_depth) return {};
  const double low = 1 / options_.max_depth_m, high = 1 / options_.min_depth_m;
  if (best.inverse_depth < low + steps.step || best.inverse_depth > high - steps.step) return {};
  return best;
}

std::vector<EdgeDepth> EdgeStereo::Measure(int key, const std::vector<int>& chosen, int stride,
                                           double typical_depth) const {
  const PosedEdges& own = views_[key];
  std::vector<StereoNeighbour> neighbours;
  neighbours.reserve(chosen.size());
  for (const int k : chosen) neighbours.emplace_back(own, views_[k]);
  const DepthSteps steps(1 / options_.max_depth_m, 1 / options_.min_depth_m, neighbours);
  std::vector<EdgeDepth> depths;
  if (steps.steps == 0) return depths;
  DepthVotes votes(steps);
  const std::vector<EdgePixel>& edges = own.edges.edges();
  for (int e = 0; e < static_cast<int>(edges.size()); e += stride) {
    const EdgeRay ray(own, edges[e], typical_depth);
    for (StereoNeighbour& n : neighbours) n.Aim(ray, typical_depth);
    const std::optional<DepthFit> fit = BestFit(edges[e], neighbours, steps, &votes);
    if (fit) depths.push_back({e, fit->inverse_depth, fit->sigma, 0, fit->views, fit->lag, fit->lag_sigma});
  }
  return depths;
}

}  // namespace evit
