#include "common/tracking/start_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>
#include <vector>

#include "common/tracking/alignment_significance.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/place_search.h"

namespace evit {
namespace {

constexpr int kPlaces = 96;                 // poses around the centre, compared on one level of the field
constexpr int kTried = 4;                   // the best of them, from which to localise
constexpr int kLevel = 2;                   // that level: basins of some 12 pixels
constexpr std::size_t kPlacePoints = 400;   // to compare them by
constexpr std::size_t kFitPoints = 1200;    // to localise by
constexpr std::size_t kRivalPoints = 4000;  // to compare a rival by
constexpr std::int64_t kOtherPlaces = 331;  // added to a frame's number: other places than its neighbours try
constexpr int kWeakWays = 2;                // directions of which a frame says least
constexpr int kWeakSteps = 8;               // along each for once the range: centimetres
constexpr double kSameValley = 0.03;        // m, rad
constexpr double kFarthest = 2;  // times the range: what is found beyond has nothing to do with the start
constexpr double kFarthestRival =
    4;  // a false start may be kFarthest beside one that is as far from the truth

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

// Poses along the directions that the events constrain least, where turning nearly compensates for moving:
// false poses lie there, seen from the right one, and the right one seen from a false one. For each direction
// and sign the pose of highest significance, beyond the slope of the centre's own valley.
std::vector<SE3> PosesAlongWeakWays(const AlignmentSettings& settings, const SurfaceField& field,
                                    const AlignmentPoints& points, const SE3& centre, const StartRange& range,
                                    double farthest) {
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(range.position), Eigen::Vector3d::Constant(range.rotation);
  const Matrix6d information = EvaluateAlignmentExactly(settings, field, points, centre).hessian;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scale.asDiagonal() * information * scale.asDiagonal());
  const auto steps = static_cast<int>(farthest * kWeakSteps);
  std::vector<SE3> best;
  for (int way = 0; way < kWeakWays; ++way) {
    for (const int side : {-1, 1}) {
      const Vector6d step = scale.cwiseProduct(solver.eigenvectors().col(way)) * side / kWeakSteps;
      double before = AlignmentSignificance(settings, field, points, centre), most = 0;
      bool climbing = false;
      for (int k = 1; k <= steps; ++k) {
        const SE3 pose((centre.q * ExpSO3(k * step.tail<3>())).normalized(), centre.p + k * step.head<3>());
        const double significance = AlignmentSignificance(settings, field, points, pose);
        climbing = climbing || significance > before;
        before = significance;
        if (!climbing || significance <= most) continue;
        if (most == 0) best.push_back(pose);
        most = significance, best.back() = pose;
      }
    }
  }
  return best;
}

// Of so many poses around the centre, those with the least cost.
std::vector<SE3> BestPlaces(const AlignmentSettings& settings, const SurfaceField& field, int level,
                            const AlignmentPoints& points, const SE3& centre, const StartRange& range,
                            std::int64_t frame) {
  std::vector<std::pair<double, SE3>> places;
  for (int k = 0; k < kPlaces; ++k) {
    const SE3 pose = PoseAround(centre, range, 1 + k + kPlaces * static_cast<int>(frame % 1000));
    places.emplace_back(EvaluateAlignment(settings, field, level, points, pose, false).cost, pose);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SE3> best;
  best.reserve(kTried);
  for (int k = 0; k < kTried; ++k) best.push_back(places[k].second);
  return best;
}

// SearchStart(), whose result lies at most `farthest` times the range from the centre.
LocalizerResult Search(const AlignmentSettings& settings, const SurfaceField& field,
                       const AlignmentPoints& points, const SE3& centre, const StartRange& range,
                       double farthest, std::int64_t frame, int rounds) {
  const AlignmentPoints few = Thinned(points, kPlacePoints), some = Thinned(points, kFitPoints);
  const int level = std::min(field.levels() - 1, kLevel);
  StartRange from_place = range, from_weak = range, finest = range;
  from_place.levels = level + 1;
  from_weak.levels = std::min(field.levels(), 2);  // already beside their events
  finest.levels = 1;
  const auto near = [&](const SE3& pose) {
    return (pose.p - centre.p).norm() < farthest * range.position &&
           AngularDistance(pose.q, centre.q) < farthest * range.rotation;
  };
  LocalizerResult best = LocalizeBest(settings, field, some, centre, range);
  if (!near(best.T_map_body)) {
    best.T_map_body = centre;
    best.significance = AlignmentSignificance(settings, field, some, centre);
  }
  int iterations = best.iterations;
  const auto try_from = [&](const SE3& pose, const StartRange& from) {
    const LocalizerResult fit = Localize(settings, field, some, pose, from);
    iterations += fit.iterations;
    if (near(fit.T_map_body) && fit.significance > best.significance) best = fit;
  };
  for (int round = 0; round < rounds; ++round) {
    for (const SE3& pose :
         BestPlaces(settings, field, level, few, centre, range, frame + round * kOtherPlaces))
      try_from(pose, from_place);
  }
  for (const SE3& pose : PosesAlongWeakWays(settings, field, few, best.T_map_body, range, farthest))
    try_from(pose, from_weak);
  best = LocalizeBest(settings, field, points, best.T_map_body, finest);
  best.iterations += iterations;
  return best;
}

StartRival Compare(const AlignmentSettings& settings, const SurfaceField& field,
                   const AlignmentPoints& points, const SE3& T_map_body, const SE3& other) {
  StartRival rival;
  rival.T_map_body = other;
  rival.distinct =
      (other.p - T_map_body.p).norm() > kSameValley || AngularDistance(other.q, T_map_body.q) > kSameValley;
  rival.significance = SignificanceOver(settings, field, points, T_map_body, other);
  return rival;
}

}  // namespace

LocalizerResult SearchStart(const AlignmentSettings& settings, const SurfaceField& field,
                            const AlignmentPoints& points, const SE3& centre, const StartRange& range,
                            std::int64_t frame) {
  return Search(settings, field, points, centre, range, kFarthest, frame, 1);
}

StartRival FindRival(const AlignmentSettings& settings, const SurfaceField& field,
                     const AlignmentPoints& points, const SE3& T_map_body, const StartRange& range,
                     std::int64_t frame, int rounds) {
  const AlignmentPoints some = Thinned(points, kRivalPoints);
  return Compare(settings, field, some, T_map_body,
                 Search(settings, field, some, T_map_body, range, kFarthestRival, frame, rounds).T_map_body);
}

StartRival FindRivalAround(const AlignmentSettings& settings, const SurfaceField& field,
                           const AlignmentPoints& points, const SE3& T_map_body, const SE3& centre,
                           const StartRange& range, std::int64_t frame, int rounds) {
  const AlignmentPoints some = Thinned(points, kRivalPoints);
  return Compare(settings, field, some, T_map_body,
                 Search(settings, field, some, centre, range, kFarthest, frame, rounds).T_map_body);
}

}  // namespace evit
