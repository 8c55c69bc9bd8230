#include "common/tracking/place_search.h"

namespace evit {

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
