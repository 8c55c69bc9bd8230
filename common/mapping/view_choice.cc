#include "common/mapping/view_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/degrees.h"

namespace evit {
namespace {

// Share of 5 x 5 places of the key view, put at `depth`, that lie in the other view.
double Overlap(const PosedEdges& key, const PosedEdges& other, double depth) {
  const PinholeView view(other.T_map_camera, other.camera);
  const Camera& c = key.camera;
  int seen = 0;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      const Eigen::Vector3d ray(((column + 0.5) / 5 * c.width - c.cx) / c.fx,
                                ((row + 0.5) / 5 * c.height - c.cy) / c.fy, 1);
      const Eigen::Vector3d p = view.InCamera(key.T_map_camera * (depth * ray));
      if (p.z() > 0.1 * depth && view.camera.Contains(view.Pixel(p))) ++seen;
    }
  }
  return seen / 25.0;
}

}  // namespace

std::vector<int> ChooseKeyViews(const std::vector<PosedEdges>& views, const ViewChoiceOptions& options) {
  std::vector<int> keys;
  for (int k = 0; k < static_cast<int>(views.size()); ++k) {
    const SE3& pose = views[k].T_map_camera;
    const bool near = std::any_of(keys.begin(), keys.end(), [&](int key) {
      const SE3& other = views[key].T_map_camera;
      return (pose.p - other.p).norm() < options.key_distance_m &&
             AngularDistance(pose.q, other.q) < options.key_angle_deg * kRadiansPerDegree;
    });
    if (!near) keys.push_back(k);
  }
  const std::size_t all = keys.size(), most = static_cast<std::size_t>(std::max(1, options.max_keys));
  if (all <= most) return keys;
  for (std::size_t k = 0; k < most; ++k) keys[k] = keys[k * all / most];
  keys.resize(most);
  return keys;
}

std::vector<int> ChooseNeighbours(const std::vector<PosedEdges>& views, int key, double depth,
                                  const ViewChoiceOptions& options) {
  struct Candidate {
    int view;
    Eigen::Vector2d parallax;  // rad, in the key's picture
    double away;               // from the nearest chosen
  };
  const PosedEdges& own = views[key];
  const SE3 T_key_map = own.T_map_camera.Inverse();
  std::vector<Candidate> candidates;
  for (int k = 0; k < static_cast<int>(views.size()); ++k) {
    const Eigen::Vector3d at = T_key_map * views[k].T_map_camera.p;
    const Eigen::Vector2d parallax = at.head<2>() / depth;
    const double size = parallax.norm();
    if (k == key || size < options.min_parallax_deg * kRadiansPerDegree ||
        size > options.max_parallax_deg * kRadiansPerDegree)
      continue;
    if (at.norm() > 0.5 * depth || Overlap(own, views[k], depth) < options.min_overlap) continue;
    candidates.push_back({k, parallax, size});
  }
  // Always the one that is farthest from all before it, the key view itself being the first.
  std::vector<int> chosen;
  while (chosen.size() < static_cast<std::size_t>(options.neighbours)) {
    const auto next = std::max_element(candidates.begin(), candidates.end(),
                                       [](const auto& a, const auto& b) { return a.away < b.away; });
    if (next == candidates.end() || next->away <= 0) break;
    chosen.push_back(next->view);
    const Eigen::Vector2d taken = next->parallax;
    for (Candidate& c : candidates) c.away = std::min(c.away, (c.parallax - taken).norm());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace evit
