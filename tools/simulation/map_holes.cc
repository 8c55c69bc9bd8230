#include "tools/simulation/map_holes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/simulation/random.h"

namespace evit::simulation {

void CutHoles(const MapHoles& holes, std::uint64_t seed, PointMap* map) {
  Random random(seed, 0x401E5);
  auto to_go = static_cast<std::size_t>(std::llround(holes.share * static_cast<double>(map->points.size())));
  const auto radius = static_cast<float>(0.5 * holes.diameter_m);
  std::vector<Eigen::Vector3f>& points = map->points;
  while (to_go > 0 && !points.empty()) {
    const Eigen::Vector3f centre = points[random.Next() % points.size()];
    const auto inside = [&](const Eigen::Vector3f& p) {
      if (to_go == 0 || (p - centre).squaredNorm() > radius * radius) return false;
      --to_go;
      return true;
    };
    std::size_t kept = 0;
    for (const Eigen::Vector3f& p : points) {
      if (!inside(p)) points[kept++] = p;
    }
    points.resize(kept);
  }
}

}  // namespace evit::simulation
