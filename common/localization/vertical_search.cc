#include "common/localization/vertical_search.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/so3.h"

namespace evit {
namespace {

constexpr double kReach = 0.14;      // rad: of a search
constexpr double kMissed = 0.3;      // probability that a search with the right vertical misses
constexpr double kForgotten = 2;     // s
constexpr double kGrid = 0.06;       // rad
constexpr int kFarthest = 10;        // of them: 34 degrees
constexpr double kDoubt = 0.2;       // share of cases in which the estimate is worse than it says
constexpr double kDoubtSigma = 0.1;  // rad: then; and three times the estimate's own

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double Density(double angle, double sigma) {
  return std::exp(-0.5 * angle * angle / (sigma * sigma)) / (sigma * sigma);
}

}  // namespace

Eigen::Vector3d VerticalSearch::Next(const Upright& upright, const Eigen::Quaterniond& R_now_before,
                                     double seconds) {
  for (Tried& tried : tried_) tried.up = R_now_before * tried.up, tried.age += seconds;
  tried_.erase(
      std::remove_if(tried_.begin(), tried_.end(), [](const Tried& t) { return t.age > kForgotten; }),
      tried_.end());
  // An even grid of verticals around the estimate, which is the first; and how likely each is.
  struct Vertical {
    Eigen::Vector3d up;
    double weight;
  };
  std::vector<Vertical> verticals;
  const Eigen::Vector3d a = upright.up.unitOrthogonal(), b = upright.up.cross(a);
  const double sigma = std::max(upright.sigma, 0.5 * kGrid), wide = std::hypot(kDoubtSigma, 3 * sigma);
  for (int i = -kFarthest; i <= kFarthest; ++i) {
    for (int j = -kFarthest; j <= kFarthest; ++j) {
      const double angle = kGrid * std::hypot(i, j);
      if (angle > kFarthest * kGrid) continue;
      const Eigen::Vector3d up = ExpSO3(kGrid * (i * a + j * b)) * upright.up;
      double weight = (1 - kDoubt) * Density(angle, sigma) + kDoubt * Density(angle, wide);
      for (const Tried& tried : tried_)
        if (Angle(up, tried.up) < kReach) weight *= kMissed + (1 - kMissed) * tried.age / kForgotten;
      verticals.push_back({up, weight});
    }
  }
  std::swap(verticals.front(), verticals[verticals.size() / 2]);
  const double reach = std::cos(kReach);
  const Vertical* best = nullptr;
  double most = 0;
  for (const Vertical& centre : verticals) {
    double sum = 0;
    for (const Vertical& v : verticals)
      if (centre.up.dot(v.up) > reach) sum += v.weight;
    if (best == nullptr || sum > most * (1 + 1e-9)) best = &centre, most = sum;
  }
  tried_.push_back({best->up, 0});
  return best->up;
}

}  // namespace evit
