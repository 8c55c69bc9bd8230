#include "tools/simulation/noise_source.h"

#include <algorithm>
#include <cmath>

namespace evit::simulation {

NoiseSource::NoiseSource(int width, int height, const EventSensorSettings& settings, std::uint64_t seed)
    : width_(width), height_(height), random_(seed, 0x4015E) {
  const auto add = [&](double hz, int x, int y) {
    if (hz <= 0) return;
    const double mean = 1e6 / hz;
    processes_.push_back({random_.Exponential(mean), mean, x, y});
  };
  add(settings.noise_hz * width * height, -1, -1);
  for (int i = 0; i < settings.hot_pixels; ++i) {
    const int x = random_.Integer(0, width - 1), y = random_.Integer(0, height - 1);
    add(random_.Uniform(settings.hot_min_hz, settings.hot_max_hz), x, y);
  }
}

void NoiseSource::Until(std::int32_t t1, std::vector<EventSensor::Event>* events) {
  for (Process& process : processes_) {
    while (process.next <= t1) {
      const int x = process.x >= 0 ? process.x : random_.Integer(0, width_ - 1);
      const int y = process.y >= 0 ? process.y : random_.Integer(0, height_ - 1);
      const auto t = std::max<std::int32_t>(1, static_cast<std::int32_t>(std::ceil(process.next)));
      events->push_back({std::min(t, t1), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                         static_cast<std::uint8_t>(random_.Chance(0.5))});
      process.next += random_.Exponential(process.mean_us);
    }
  }
}

}  // namespace evit::simulation
