#include "common/tracking/place_search.h"

#include <algorithm>

namespace evit {
namespace {

constexpr int kAnchorOnly = 5;       // rejected frames, before places around the anchor are tried
constexpr int kPlaces = 96;          // of them for each frame
constexpr int kPlacePoints = 320;    // that they are compared by
constexpr double kNarrowest = 0.1;   // m: radius of the ball they lie in
constexpr double kWidest = 1;        // m
constexpr double kWidening = 0.004;  // m per frame, of some 10 ms

}  // namespace

double Halton(int k, int base) {
  double value = 0, digit = 1;
  for (; k > 0; k /= base) {
    digit /= base;
    value += digit * (k % base);
  }
  return value;
}

Eigen::Vector3d PlaceInBall(int k, double radius) {
  if (k == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d cube(2 * Halton(k, 2) - 1, 2 * Halton(k, 3) - 1, 2 * Halton(k, 5) - 1);
  // From the cube onto the ball, so that no place is thrown away.
  const double edge = cube.cwiseAbs().maxCoeff();
  return edge > 0 ? Eigen::Vector3d(radius * edge * cube.normalized()) : cube;
}

SE3 InitialPose(const AlignmentSettings& settings, const PointSelector& points, const SurfaceField& field,
                const BodyState& anchor, const Eigen::Vector3d& rate, int rejected, std::int64_t seq) {
  const SE3& centre = anchor.T_map_body;
  if (rejected <= kAnchorOnly) return centre;
  const double radius = std::min(kWidest, kNarrowest + kWidening * rejected);
  return BestPlace(settings, field, points.Select(anchor, rate, kPlacePoints, seq), centre, radius,
                   1 + kPlaces * rejected, kPlaces);
}

SE3 BestPlace(const AlignmentSettings& settings, const SurfaceField& field, const AlignmentPoints& points,
              const SE3& centre, double radius, int first, int count) {
  const int level = field.levels() - 1;
  SE3 best = centre;
  double least = EvaluateAlignment(settings, field, level, points, centre, false).cost;
  for (int k = first; k < first + count; ++k) {
    SE3 pose = centre;
    pose.p += PlaceInBall(k, radius);
    const double cost = EvaluateAlignment(settings, field, level, points, pose, false).cost;
    if (cost < least) least = cost, best = pose;
  }
  return best;
}

}  // namespace evit
