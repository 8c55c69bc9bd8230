// Visible points of a map, against one point after the other in double with a depth image.
#include <random>

#include "bench/counters.h"
#include "tests/helpers/clouds.h"

namespace evit::bench {
namespace {

constexpr std::size_t kPoints = 500'000;

PointMap Cloud() { return test::Room(kPoints, {4, 3, 1.5F}, 3); }

VisibilityQuery Query() {
  VisibilityQuery q;
  q.camera = test::PlumbBob();
  q.margin_px = 40;
  q.max_points = 5000;
  return q;
}

void Ours(benchmark::State& state) {
  const MapIndex index(Cloud());
  VisibilityQuery q = Query();
  std::mt19937 random(1);
  double visible = 0, n = 0;
  for (auto _ : state) {
    state.PauseTiming();
    q.T_map_camera = test::RandomPose(&random, 1);
    state.ResumeTiming();
    visible += index.Query(q).n_visible;
    ++n;
  }
  state.counters["visible"] = visible / n;
  PerCall(state, 2e-3, visible / n * 12);
}
BENCHMARK(Ours)->Name("Visible points of 500,000/ours")->Unit(benchmark::kMillisecond);

void Reference(benchmark::State& state) {
  const PointMap map = Cloud();
  VisibilityQuery q = Query();
  std::mt19937 random(1);
  for (auto _ : state) {
    state.PauseTiming();
    q.T_map_camera = test::RandomPose(&random, 1);
    state.ResumeTiming();
    std::vector<float> depth(std::size_t{640} * 480, 1e9F);
    std::vector<std::pair<std::int32_t, Eigen::Vector3d>> seen;
    const SE3 T = q.T_map_camera.Inverse();
    for (std::size_t k = 0; k < map.points.size(); ++k) {
      const Eigen::Vector3d p = T * map.points[k].cast<double>();
      Eigen::Vector2d pixel;
      if (p.z() < q.min_depth || p.z() > q.max_depth || !q.camera.Project(p, &pixel) ||
          !q.camera.Contains(pixel)) {
        continue;
      }
      seen.emplace_back(static_cast<std::int32_t>(k), Eigen::Vector3d(pixel.x(), pixel.y(), p.z()));
      float& d = depth[static_cast<std::size_t>(pixel.y()) * 640 + static_cast<std::size_t>(pixel.x())];
      d = std::min(d, static_cast<float>(p.z()));
    }
    std::vector<std::int32_t> ids;
    for (const auto& [id, p] : seen) {
      const float d = depth[static_cast<std::size_t>(p.y()) * 640 + static_cast<std::size_t>(p.x())];
      if (p.z() < 1.1 * static_cast<double>(d)) ids.push_back(id);
    }
    std::shuffle(ids.begin(), ids.end(), random);
    ids.resize(std::min<std::size_t>(ids.size(), 5000));
    benchmark::DoNotOptimize(ids.data());
  }
}
BENCHMARK(Reference)->Name("Visible points of 500,000/reference")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evit::bench
