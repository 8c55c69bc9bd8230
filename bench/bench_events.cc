// Surface of active events, time surfaces and the packet codec.
#include <stdexcept>

#include "bench/counters.h"
#include "bench/moving_edges.h"
#include "common/bus/codec.h"
#include "common/events/hot_pixels.h"
#include "common/events/reference_surface.h"
#include "common/events/surface_renderer.h"
#include "common/wire/event_wire.h"

namespace evit::bench {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr std::size_t kEvents = 1'000'000;
constexpr double kRate = 3e6;  // events/s

const EventArray& Events() {
  static const EventArray events = MovingEdges(kEvents, kRate);
  return events;
}

SurfaceOptions Settings() {
  SurfaceOptions s;
  s.kind = SurfaceOptions::Kind::kSymmetric;
  s.truncation = 20;
  s.blur_sigma_px = 1;
  s.support_filter = true;
  return s;
}

void UpdateOurs(benchmark::State& state) {
  ActiveEventSurface surface(kWidth, kHeight);
  const EventArray& e = Events();
  for (auto _ : state) {
    surface.Clear();
    surface.Update(e.t.data(), e.x.data(), e.y.data(), e.size());
  }
  PerSecond(state, kEvents, 300e6, 16);  // 12 read, 4 written
}
BENCHMARK(UpdateOurs)->Name("Surface update/ours")->Unit(benchmark::kMillisecond);

void UpdateReference(benchmark::State& state) {
  ReferenceSurface surface(kWidth, kHeight, Settings());
  for (auto _ : state) surface.Update(Events(), 0, kEvents);
  PerSecond(state, kEvents, 0, 0);
}
BENCHMARK(UpdateReference)->Name("Surface update/reference")->Unit(benchmark::kMillisecond);

void HotPixelsOurs(benchmark::State& state) {
  HotPixels hot(kWidth, kHeight, 100);
  for (auto _ : state) {
    hot.Clear();
    hot.Update(Events(), 0, kEvents);
  }
  PerSecond(state, kEvents, 300e6, 6);
}
BENCHMARK(HotPixelsOurs)->Name("Hot pixel counts/ours")->Unit(benchmark::kMillisecond);

void RenderOurs(benchmark::State& state) {
  ActiveEventSurface surface(kWidth, kHeight);
  SurfaceRenderer renderer(kWidth, kHeight, Settings());
  const EventArray& e = Events();
  surface.Update(e.t.data(), e.x.data(), e.y.data(), e.size());
  SurfaceRenderer::View view;
  view.t = e.t.back();
  view.decay_us = 10'000;
  for (auto _ : state) benchmark::DoNotOptimize(renderer.Render(surface, view));
  PerCall(state, 0.3e-3, kWidth * kHeight * 9.0);
}
BENCHMARK(RenderOurs)->Name("Render one surface/ours")->Unit(benchmark::kMillisecond);

void RenderReference(benchmark::State& state) {
  ReferenceSurface surface(kWidth, kHeight, Settings());
  surface.Update(Events(), 0, kEvents);
  for (auto _ : state) benchmark::DoNotOptimize(surface.Render(Events().t.back(), 10'000));
}
BENCHMARK(RenderReference)->Name("Render one surface/reference")->Unit(benchmark::kMillisecond);

std::vector<std::vector<std::uint8_t>> Encoded() {
  std::vector<std::vector<std::uint8_t>> out;
  for (const event_packet_t& packet : ToPackets(Events(), 1, 0)) {
    out.emplace_back();
    EncodeTo(packet, &out.back());
  }
  return out;
}

void Encode(benchmark::State& state) {
  std::vector<std::uint8_t> buffer;
  for (auto _ : state) {
    for (std::size_t begin = 0; begin < kEvents;) begin = EncodePacket(Events(), begin, 1, 0, &buffer);
  }
  PerSecond(state, kEvents, 300e6, 13 + 9);
}
BENCHMARK(Encode)->Name("Packet encode, with checks/ours")->Unit(benchmark::kMillisecond);

void Decode(benchmark::State& state) {
  const auto encoded = Encoded();
  EventArray events;
  event_packet_t packet;
  for (auto _ : state) {
    events.clear();
    for (const auto& bytes : encoded) {
      if (!DecodeChecked(bytes.data(), bytes.size(), &packet)) throw std::logic_error("packet refused");
      AppendEvents(packet, &events);
    }
  }
  PerSecond(state, kEvents, 300e6, 9 + 9 + 9 + 13);
}
BENCHMARK(Decode)->Name("Packet decode, with checks/ours")->Unit(benchmark::kMillisecond);

// Structs of one event each, field by field in big-endian, checked one by one.
struct PlainEvent {
  std::int32_t dt;
  std::int16_t x, y;
  std::uint8_t p;
};

void EncodeReference(benchmark::State& state) {
  std::vector<PlainEvent> plain;
  const EventArray& e = Events();
  for (std::size_t k = 0; k < e.size(); ++k) {
    plain.push_back({static_cast<std::int32_t>(e.t[k] - e.t[0]), static_cast<std::int16_t>(e.x[k]),
                     static_cast<std::int16_t>(e.y[k]), e.p[k]});
  }
  std::vector<std::uint8_t> bytes;
  for (auto _ : state) {
    bytes.clear();
    for (const PlainEvent& event : plain) {
      for (int s = 24; s >= 0; s -= 8) bytes.push_back(static_cast<std::uint8_t>(event.dt >> s));
      for (int s = 8; s >= 0; s -= 8) bytes.push_back(static_cast<std::uint8_t>(event.x >> s));
      for (int s = 8; s >= 0; s -= 8) bytes.push_back(static_cast<std::uint8_t>(event.y >> s));
      bytes.push_back(event.p);
    }
    benchmark::DoNotOptimize(bytes.data());
  }
  PerSecond(state, kEvents, 0, 0);
}
BENCHMARK(EncodeReference)->Name("Packet encode, with checks/reference")->Unit(benchmark::kMillisecond);

void DecodeReference(benchmark::State& state) {
  std::vector<std::uint8_t> bytes(kEvents * 9, 1);
  for (auto _ : state) {
    std::vector<PlainEvent> plain;
    for (std::size_t k = 0; k + 9 <= bytes.size(); k += 9) {
      const std::uint8_t* b = bytes.data() + k;
      const PlainEvent e{b[0] << 24 | b[1] << 16 | b[2] << 8 | b[3],
                         static_cast<std::int16_t>(b[4] << 8 | b[5]),
                         static_cast<std::int16_t>(b[6] << 8 | b[7]), b[8]};
      if (e.x < 0 || e.y < 0 || e.p > 1) continue;
      plain.push_back(e);
    }
    benchmark::DoNotOptimize(plain.data());
  }
  PerSecond(state, kEvents, 0, 0);
}
BENCHMARK(DecodeReference)->Name("Packet decode, with checks/reference")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace evit::bench
