#include "common/mapping/edge_stereo.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace evit {
namespace {

constexpr int kMaxSteps = 1024;  // inverse depths tried
constexpr int kPeaks = 4;        // of the votes that are looked at closely
constexpr double kInlierPx = 1.2;
constexpr double kKernelPx = 0.7;  // scale of the Cauchy kernel

}  // namespace

// A neighbouring view as the key view sees it: a point at inverse depth w on the key's ray is R ray + w t.
struct EdgeStereo::Neighbour {
  const PosedEdges* view;
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  // Of the edge at hand: R ray; the normal that is expected; bin of it.
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();
  int bin = 0;
  bool shows = true;  // this edge, when it is as far away as most
  double late = 0;    // derivative of its distance by the lag: the same in views with the same way is none
};

struct EdgeStereo::Fit {
  double inverse_depth = 0, sigma = 0, support = 0, views = 0, share = 0;
  double lag = 0, lag_sigma = 0;
};

std::vector<EdgeStereo::Neighbour> EdgeStereo::Prepare(int key, const std::vector<int>& neighbours) const {
  std::vector<Neighbour> prepared;
  for (const int k : neighbours) {
    const SE3 T = views_[k].T_map_camera.Inverse() * views_[key].T_map_camera;
    prepared.push_back({&views_[k], T.R(), T.p});
  }
  return prepared;
}

EdgeStereo::Fit EdgeStereo::Refine(const EdgePixel& edge, const std::vector<Neighbour>& neighbours,
                                   double inverse_depth, double step) const {
  Fit fit;
  fit.inverse_depth = inverse_depth;
  const double low = 1 / options_.max_depth_m, high = 1 / options_.min_depth_m;
  for (int round = 0; round < 5; ++round) {
    // Unknowns: the inverse depth; by how much the key view's own edge is misplaced across (in units of
    // sigma); and by how many pixels events come late.
    const double per_lag2 = 1 / (options_.lag_sigma_px * options_.lag_sigma_px);
    double a = 0, b = 0, c = 1, ga = 0, gb = 0, visible = 0;
    double al = 0, bl = 0, l = per_lag2, gl = 0;
    fit.support = fit.views = 0;
    for (const Neighbour& n : neighbours) {
      if (!n.shows) continue;
      const Eigen::Vector3d p = n.far + fit.inverse_depth * n.t;
      if (p.z() < 0.05) continue;
      const Camera& camera = n.view->camera;
      const Eigen::Vector2d pixel(camera.fx * p.x() / p.z() + camera.cx,
                                  camera.fy * p.y() / p.z() + camera.cy);
      if (!camera.Contains(pixel, 4)) continue;
      ++visible;
      EdgeImage::Query query;
      query.pixel = pixel.cast<float>();
      query.normal = n.normal;
      query.radius = round == 0 ? 2.5F : 1.8F;
      const EdgePixel* match = n.view->edges.Match(query);
      if (match == nullptr) continue;
      if (n.view->edges.has_sides() &&
          std::min(std::abs(match->dark - edge.dark), std::abs(match->bright - edge.bright)) >
              options_.side_tolerance) {
        continue;
      }
      const Eigen::Vector2d normal = match->normal.cast<double>();
      const double r = normal.dot(pixel - match->pixel.cast<double>()) / options_.edge_sigma_px;
      const Eigen::Vector2d move(camera.fx * (n.t.x() * p.z() - p.x() * n.t.z()) / (p.z() * p.z()),
                                 camera.fy * (n.t.y() * p.z() - p.y() * n.t.z()) / (p.z() * p.z()));
      const double j = normal.dot(move) / options_.edge_sigma_px;
      const double scaled = r * options_.edge_sigma_px / kKernelPx;
      const double w = 1 / (1 + scaled * scaled);
      // An edge along the epipolar line says nothing, however its direction is measured: what an error of it
      // seems to say is taken off again.
      const double seeming = options_.normal_sigma * move.norm() / options_.edge_sigma_px;
      a += w * (j * j - seeming * seeming), b += w * j, c += w;
      ga += w * j * r, gb += w * r;
      const double late = n.late / options_.edge_sigma_px;
      al += w * j * late, bl += w * late, l += w * late * late, gl += w * r * late;
      if (std::abs(r) * options_.edge_sigma_px < kInlierPx) ++fit.views, fit.support += w;
    }
    fit.share = visible > 0 ? fit.views / visible : 0;
    // The lag first: without event views it is its prior's, and nothing changes.
    a -= al * al / l, b -= al * bl / l, c -= bl * bl / l;
    ga -= al * gl / l, gb -= bl * gl / l;
    const double information = a - b * b / c;
    if (fit.views < options_.min_views || information <= 0) return {};
    fit.sigma = 1 / std::sqrt(information);
    const double move = -(ga - b * gb / c) / information;
    const double own = -(gb + b * move) / c;
    fit.lag = (gl + al * move + bl * own) / l;  // what is left of the distances is what the lag makes of them
    fit.lag_sigma = l > 1.5 * per_lag2 ? 1 / std::sqrt(l) : 0;
    fit.inverse_depth = std::clamp(fit.inverse_depth + std::clamp(move, -2 * step, 2 * step), low, high);
    if (round > 0 && std::abs(move) < 0.02 * step) break;
  }
  return fit;
}

std::vector<EdgeDepth> EdgeStereo::Measure(int key, const std::vector<int>& chosen, int stride,
                                           double typical_depth) const {
  const PosedEdges& own = views_[key];
  std::vector<Neighbour> neighbours = Prepare(key, chosen);
  std::vector<EdgeDepth> depths;
  double largest = 0;  // pixels that the inverse depth 1/m makes
  for (const Neighbour& n : neighbours)
    largest = std::max(largest, n.t.norm() * std::max(n.view->camera.fx, n.view->camera.fy));
  if (largest <= 0) return depths;
  const double low = 1 / options_.max_depth_m, high = 1 / options_.min_depth_m;
  const int steps = std::clamp(static_cast<int>((high - low) * largest) + 2, 8, kMaxSteps);
  const double step = (high - low) / (steps - 1);

  std::vector<int> votes(steps), seen(steps);
  std::vector<float> score(steps);
  const std::vector<EdgePixel>& edges = own.edges.edges();
  for (int e = 0; e < static_cast<int>(edges.size()); e += stride) {
    const EdgePixel& edge = edges[e];
    const Camera& c = own.camera;
    const Eigen::Vector3d ray((edge.pixel.x() - c.cx) / c.fx, (edge.pixel.y() - c.cy) / c.fy, 1);
    const Eigen::Vector3d tangent(edge.normal.y() / c.fx, -edge.normal.x() / c.fy, 0);
    const int own_way = own.sweep.Way(c, ray * typical_depth, edge.normal);
    std::fill(votes.begin(), votes.end(), 0);
    std::fill(seen.begin(), seen.end(), 0);
    for (Neighbour& n : neighbours) {
      n.far = n.R * ray;
      // The tangent turned as the cameras are to each other; the normal is on its left.
      const Eigen::Vector3d along = n.R * tangent;
      const Camera& camera = n.view->camera;
      n.shows = n.far.z() >= 0.1;
      if (!n.shows) continue;
      const Eigen::Vector2d image(camera.fx * (along.x() - n.far.x() / n.far.z() * along.z()),
                                  camera.fy * (along.y() - n.far.y() / n.far.z() * along.z()));
      n.normal = Eigen::Vector2f(static_cast<float>(-image.y()), static_cast<float>(image.x())).normalized();
      n.bin = EdgeImage::BinOf(n.normal);
      const Eigen::Vector3d there = n.far * typical_depth + n.t;
      n.shows = n.view->sweep.Shows(camera, there, n.normal);
      if (!n.shows) continue;
      n.late = n.view->sweep.Way(camera, there, n.normal) - own_way;
      const EdgeImage& image_edges = n.view->edges;
      const auto width = static_cast<float>(image_edges.width() - 5);
      const auto height = static_cast<float>(image_edges.height() - 5);
      const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
      const float cx = static_cast<float>(camera.cx) + 0.5F, cy = static_cast<float>(camera.cy) + 0.5F;
      const Eigen::Vector3f first = (n.far + low * n.t).cast<float>(), move = (step * n.t).cast<float>();
      for (int k = 0; k < steps; ++k) {
        const auto f = static_cast<float>(k);
        const float z = first.z() + f * move.z();
        if (z < 0.05F) continue;
        const float x = fx * (first.x() + f * move.x()) / z + cx,
                    y = fy * (first.y() + f * move.y()) / z + cy;
        if (!(x >= 4 && y >= 4 && x < width && y < height)) continue;
        ++seen[k];
        votes[k] += image_edges.Vote(static_cast<int>(x), static_cast<int>(y), n.bin);
      }
    }
    for (int k = 0; k < steps; ++k) {
      score[k] = seen[k] >= options_.min_views
                     ? static_cast<float>(votes[k]) / static_cast<float>(2 * seen[k])
                     : 0.0F;
    }
    // Peaks, highest first; a plateau counts once, by its middle.
    std::array<std::pair<float, double>, kPeaks> peaks{};
    for (int k = 0; k < steps;) {
      int end = k + 1;
      while (end < steps && score[end] == score[k]) ++end;
      const bool peak = score[k] >= 0.6F * static_cast<float>(options_.min_share) &&
                        (k == 0 || score[k - 1] < score[k]) && (end == steps || score[end] < score[k]);
      if (peak && score[k] > peaks.back().first) {
        peaks.back() = {score[k], low + step * 0.5 * (k + end - 1)};
        std::stable_sort(peaks.begin(), peaks.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
      }
      k = end;
    }
    Fit best, rival;
    for (const auto& [height, at] : peaks) {
      if (height <= 0) break;
      const Fit fit = Refine(edge, neighbours, at, step);
      if (fit.views <= 0) continue;
      if (best.views > 0 && std::abs(fit.inverse_depth - best.inverse_depth) <
                                std::max(2 * step, 2 * std::max(fit.sigma, best.sigma))) {
        if (fit.support > best.support) best = fit;  // the same place
      } else if (fit.support * fit.share > best.support * best.share) {
        rival = best, best = fit;
      } else if (fit.support * fit.share > rival.support * rival.share) {
        rival = fit;
      }
    }
    if (best.views < options_.min_views || best.share < options_.min_share) continue;
    if (rival.support * rival.share > options_.max_rival_share * best.support * best.share) continue;
    if (best.sigma > options_.max_relative_sigma * best.inverse_depth) continue;
    if (best.inverse_depth < low + step || best.inverse_depth > high - step) continue;
    depths.push_back({e, best.inverse_depth, best.sigma, 0, best.views, best.lag, best.lag_sigma});
  }
  return depths;
}

}  // namespace evit
