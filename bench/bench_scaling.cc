// How the cost of a second of data grows with the event rate, and that of a query with the size of the map.
#include <random>

#include "bench/counters.h"
#include "bench/moving_edges.h"
#include "common/bus/codec.h"
#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/events/keyframe_builder.h"
#include "common/wire/event_wire.h"
#include "tests/helpers/clouds.h"
#include "tests/helpers/paths.h"

namespace evit::bench {
namespace {

// What frame_builder does with one second of packets while tracking, `rate` events of a sensor of this size:
// decode, merge, surfaces, keyframes.
void OneSecond(benchmark::State& state, double rate, int width, int height) {
  EventArray sweep = MovingEdges(static_cast<std::size_t>(rate), rate);
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    sweep.x[k] = static_cast<std::uint16_t>(sweep.x[k] * width / 640);
    sweep.y[k] = static_cast<std::uint16_t>(sweep.y[k] * height / 480);
  }
  std::vector<std::vector<std::uint8_t>> packets;
  for (const event_packet_t& packet : ToPackets(sweep, 1, 0)) {
    packets.emplace_back();
    EncodeTo(packet, &packets.back());
  }
  Rig rig = LoadRig(test::SourcePath("config/vector/rig.textproto"));
  rig.camera.width = width, rig.camera.height = height;
  const PipelineOptions pipeline = LoadOptions(test::SourcePath("config/tracker.textproto"));
  TrackerFeedback feedback;
  feedback.mode = TrackerFeedback::Mode::kTracking;
  feedback.image_speed = 300;
  EventArray events;
  event_packet_t packet;
  double keyframes = 0, seconds = 0;
  for (auto _ : state) {
    KeyframeBuilder builder(rig, {pipeline.keyframes, pipeline.surface, Keyframe::Encoding::kTimeSurface},
                            false);
    builder.SetFeedbackFor(-1, feedback);
    ImuSample imu{1'000'000, {0, 0, 0.1}, {0, 0, 9.81}};
    for (const auto& bytes : packets) {
      if (!DecodeChecked(bytes.data(), bytes.size(), &packet)) throw std::logic_error("packet refused");
      events.clear();
      AppendEvents(packet, &events);
      builder.AddEvents(events, events.t.back());
      for (; imu.t <= events.t.back(); imu.t += 5000) builder.AddImu(imu);
      while (auto keyframe = builder.Next()) ++keyframes;
    }
    ++seconds;
  }
  state.counters["keyframes"] = keyframes / seconds;
  state.counters["ns_per_event"] = benchmark::Counter(
      rate * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void EventRate(benchmark::State& state) {
  OneSecond(state, 1e5 * static_cast<double>(state.range(0)), 640, 480);
}
BENCHMARK(EventRate)
    ->Name("Scaling, event rate")
    ->ArgName("100 kev/s")
    ->Arg(1)
    ->Arg(2)
    ->Arg(5)
    ->Arg(10)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond);

// QVGA, VGA, 720p, full HD, each with 20 million events/s.
void Resolution(benchmark::State& state) {
  const auto height = static_cast<int>(state.range(0));
  OneSecond(state, 2e7, height * (height >= 720 ? 16 : 12) / 9, height);
}
BENCHMARK(Resolution)
    ->Name("Scaling, resolution")
    ->ArgName("lines")
    ->Arg(240)
    ->Arg(480)
    ->Arg(720)
    ->Arg(1080)
    ->Unit(benchmark::kMillisecond);

void MapSize(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0)) * 1000;
  const MapIndex index(test::Room(n, {4, 3, 1.5F}, 3));
  VisibilityQuery q;
  q.camera = test::PlumbBob();
  q.margin_px = 40;
  q.max_points = 5000;
  std::mt19937 random(1);
  std::vector<SE3> poses;
  poses.reserve(64);
  for (int k = 0; k < 64; ++k) poses.push_back(test::RandomPose(&random, 1));
  double visible = 0, queries = 0;
  for (auto _ : state) {
    q.T_map_camera = poses[static_cast<std::size_t>(queries) % poses.size()];
    visible += index.Query(q).n_visible;
    ++queries;
  }
  state.counters["visible"] = visible / queries;
  state.counters["index_MB"] = static_cast<double>(index.MemoryBytes()) * 1e-6;
}
BENCHMARK(MapSize)
    ->Name("Scaling, map size")
    ->ArgName("1000 points")
    ->Arg(10)
    ->Arg(30)
    ->Arg(100)
    ->Arg(300)
    ->Arg(1000)
    ->Arg(5000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evit::bench
