#include "common/tracking/start_search.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/tracking/alignment_significance.h"
#include "common/tracking/place_search.h"

namespace evit {
namespace {

constexpr int kPlaces = 96;                // poses around the centre, compared on one level of the field
constexpr int kTried = 4;                  // the best of them, from which to localise
constexpr int kLevel = 2;                  // that level: basins of some 12 pixels
constexpr std::size_t kPlacePoints = 400;  // to compare them by
constexpr std::size_t kFitPoints = 1200;   // to localise by
constexpr double kSameValley = 0.03;       // m, rad
constexpr double kFarthest = 2;  // times the range: what is found beyond has nothing to do with the start

AlignmentPoints Thinned(const AlignmentPoints& points, std::size_t count) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / count);
  std::vector<Eigen::Vector3f> some;
  for (std::size_t k = 0; k < points.size(); k += stride) some.push_back(points.At(k).cast<float>());
  return {some};
}

// Pose k of an even covering of all positions and rotations in the range.
SE3 PoseAround(const SE3& centre, const StartRange& range, int k) {
  const auto in_ball = [k](int a, int b, int c, double radius) {
    const Eigen::Vector3d cube(2 * Halton(k, a) - 1, 2 * Halton(k, b) - 1, 2 * Halton(k, c) - 1);
    return Eigen::Vector3d(radius * cube.cwiseAbs().maxCoeff() * cube.normalized());
  };
  SE3 pose = centre;
  pose.p += in_ball(2, 3, 5, range.position);
  pose.q = (pose.q * ExpSO3(in_ball(7, 11, 13, range.rotation))).normalized();
  return pose;
}

}  // namespace

LocalizerResult SearchStart(const AlignmentSettings& settings, const SurfaceField& field,
                            const AlignmentPoints& points, const SE3& centre, const StartRange& range,
                            std::int64_t frame) {
  const AlignmentPoints few = Thinned(points, kPlacePoints), some = Thinned(points, kFitPoints);
  const int level = std::min(field.levels() - 1, kLevel);
  StartRange from_place = range, finest = range;
  from_place.levels = level + 1;
  finest.levels = 1;
  std::vector<std::pair<double, SE3>> places;
  for (int k = 0; k < kPlaces; ++k) {
    const SE3 pose = PoseAround(centre, range, 1 + k + kPlaces * static_cast<int>(frame % 1000));
    places.emplace_back(EvaluateAlignment(settings, field, level, few, pose, false).cost, pose);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto near = [&](const SE3& pose) {
    return (pose.p - centre.p).norm() < kFarthest * range.position &&
           AngularDistance(pose.q, centre.q) < kFarthest * range.rotation;
  };
  LocalizerResult best = LocalizeBest(settings, field, some, centre, range);
  if (!near(best.T_map_body)) best.T_map_body = centre;
  double most = AlignmentSignificance(settings, field, some, best.T_map_body);
  int iterations = best.iterations;
  for (int k = 0; k < kTried; ++k) {
    const LocalizerResult fit = Localize(settings, field, some, places[k].second, from_place);
    iterations += fit.iterations;
    const double significance = AlignmentSignificance(settings, field, some, fit.T_map_body);
    if (near(fit.T_map_body) && significance > most) most = significance, best = fit;
  }
  best = LocalizeBest(settings, field, points, best.T_map_body, finest);
  best.iterations += iterations;
  return best;
}

StartRival FindRival(const AlignmentSettings& settings, const SurfaceField& field,
                     const AlignmentPoints& points, const SE3& T_map_body, const StartRange& range,
                     std::int64_t frame) {
  StartRival rival;
  rival.T_map_body = SearchStart(settings, field, points, T_map_body, range, frame).T_map_body;
  rival.distinct = (rival.T_map_body.p - T_map_body.p).norm() > kSameValley ||
                   AngularDistance(rival.T_map_body.q, T_map_body.q) > kSameValley;
  rival.significance = SignificanceOver(settings, field, points, T_map_body, rival.T_map_body);
  return rival;
}

}  // namespace evit
