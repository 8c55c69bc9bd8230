// What starting without a pose costs: the index of a large map, and one search of the whole of it, by the
// map's size.
#include <benchmark/benchmark.h>

#include <memory>
#include <random>

#include "bench/counters.h"
#include "common/localization/place_finder.h"
#include "common/localization/place_index.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit::bench {
namespace {

constexpr int kThreads = 2;
constexpr float kHeight = 3;

// A room of side x side x 3 m: level and upright lines of half a metre on its walls, on its floor and on the
// sides of boxes that stand around, points 1 cm apart.
PointMap Room(float side, std::size_t points) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> u(0, 1);
  struct Box {
    Eigen::Vector3f low, size;
  };
  std::vector<Box> boxes{{{0, 0, 0}, {side, side, kHeight}}};  // the room itself
  for (int k = 0; k < static_cast<int>(side * side / 4); ++k)
    boxes.push_back(
        {{u(rng) * side, u(rng) * side, 0}, {0.3F + u(rng), 0.3F + u(rng), 0.4F + 1.2F * u(rng)}});
  PointMap map;
  map.points.reserve(points);
  while (map.points.size() < points) {
    // As often on the room as on all the boxes.
    const Box& box = rng() % 2 == 0 ? boxes[0] : boxes[rng() % boxes.size()];
    const int normal = static_cast<int>(rng() % 8) == 0 ? 2 : static_cast<int>(rng() % 2);
    const int along = normal == 2 ? static_cast<int>(rng() % 2) : rng() % 2 == 0 ? 2 : 1 - normal;
    Eigen::Vector3f at(u(rng), u(rng), u(rng));
    at[normal] = normal == 2 ? 0 : static_cast<float>(rng() % 2);
    at = box.low + at.cwiseProduct(box.size);
    const float length = std::min(0.5F, box.low[along] + box.size[along] - at[along]);
    for (float a = 0; a < length && map.points.size() < points; a += 0.01F)
      map.points.push_back(at + a * Eigen::Vector3f::Unit(along));
  }
  return map;
}

PlaceIndexOptions Options() {
  PlaceIndexOptions options;
  options.threads = kThreads;
  return options;
}

Rig BenchRig() {
  Rig rig;
  rig.camera = synthetic::VgaCamera();
  rig.T_body_camera = synthetic::BodyCamera();
  return rig;
}

void Index(benchmark::State& state) {
  const PointMap map = Room(static_cast<float>(state.range(0)), 500'000);
  std::size_t bytes = 0, places = 0;
  double spacing = 0;
  for (auto _ : state) {
    const PlaceIndex index(map, Options());
    bytes = index.MemoryBytes(), places = index.places().size(), spacing = index.spacing();
  }
  state.counters["MB"] = 1e-6 * static_cast<double>(bytes);
  state.counters["places"] = static_cast<double>(places);
  state.counters["spacing_m"] = spacing;
  PerCall(state, 60, static_cast<double>(bytes));
}
BENCHMARK(Index)
    ->Name("Index of places, 500,000 points, side m/ours")
    ->Arg(10)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

void Search(benchmark::State& state) {
  const auto side = static_cast<float>(state.range(0));
  const auto map = std::make_unique<MapIndex>(Room(side, static_cast<std::size_t>(8'000 * side)));
  const PlaceIndex places(map->map(), Options());
  const Rig rig = BenchRig();
  PlaceFinderOptions options;
  options.threads = kThreads;
  const PlaceFinder finder(*map, places, rig, {}, {}, options);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(0, 1);
  double right = 0, n = 0;
  for (auto _ : state) {
    state.PauseTiming();
    SE3 pose(ExpSO3({0, 0, 6.28 * u(rng)}),
             {side * (0.2 + 0.6 * u(rng)), side * (0.2 + 0.6 * u(rng)), 1.2 + 0.5 * u(rng)});
    PlaceQuery query;
    query.number = static_cast<std::int64_t>(n) + 1;
    VisibilityQuery view;  // with what hides what: a room is not seen through its boxes
    view.T_map_camera = pose * rig.T_body_camera;
    view.camera = rig.camera;
    view.max_points = 1'000'000;
    std::vector<Eigen::Vector3f> seen;
    for (const std::int32_t id : map->Query(view).ids) seen.push_back(map->map().points[id]);
    query.surface = synthetic::DrawSurface(synthetic::Alignment(), seen, pose);
    query.up_body = pose.q.conjugate() * Eigen::Vector3d::UnitZ();
    state.ResumeTiming();
    const std::vector<PlaceCandidate> found = finder.Answer(query);
    right += !found.empty() && (found[0].T_map_body.p - pose.p).norm() < 0.1 ? 1 : 0;
    ++n;
  }
  state.counters["right"] = right / n;
  state.counters["places"] = static_cast<double>(places.places().size());
  state.counters["spacing_m"] = places.spacing();
  PerCall(state, side < 10 ? 1 : 5, static_cast<double>(places.MemoryBytes()));
}
BENCHMARK(Search)
    ->Name("Search of all places, side m/ours")
    ->Arg(5)
    ->Arg(20)
    ->Iterations(8)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace evit::bench
