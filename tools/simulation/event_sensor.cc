#include "tools/simulation/event_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/simd/lanes.h"
#include "tools/simulation/random.h"

namespace evit::simulation {

float FastLog(float x) {
  // x = 2^e * m with m in [sqrt(1/2), sqrt(2)); log m = 2 atanh((m-1)/(m+1)).
  std::int32_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  const std::int32_t shifted = bits - 0x3F3504F3;
  const float exponent = static_cast<float>(shifted >> 23);
  bits = (shifted & 0x7FFFFF) + 0x3F3504F3;
  float m = 0;
  std::memcpy(&m, &bits, sizeof(m));
  const float q = (m - 1) / (m + 1), q2 = q * q;
  return exponent * 0.69314718F + 2 * q * (1 + q2 * (1.0F / 3 + q2 * 0.2F));
}

EventSensor::EventSensor(int width, int height, const EventSensorSettings& settings, std::uint64_t seed)
    : width_(width),
      height_(height),
      dark_(static_cast<float>(settings.dark)),
      tau_us_(static_cast<float>(std::max(1e-3, settings.low_pass_ms * 1e3))),
      refractory_us_(static_cast<std::int32_t>(std::lround(settings.refractory_ms * 1e3))),
      bright_(static_cast<float>(settings.bright_grey)),
      leak_per_us_(static_cast<float>(settings.leak_hz * settings.threshold * 1e-6)),
      drift_(static_cast<float>(settings.threshold_drift)) {
  const std::size_t n = static_cast<std::size_t>(width) * height;
  input_.assign(n, 0);
  level_.assign(n, 0);
  stored_.resize(n);
  threshold_on_.resize(n);
  threshold_off_.resize(n);
  free_from_.assign(n, 0);
  Random waves(seed, 0xD71F7);
  for (int k = 0; k < 2; ++k) {
    drift_waves_[k] = 6.283185307179586e-6 / waves.Uniform(3, 12);  // periods of some seconds
    drift_waves_[2 + k] = waves.Uniform(0, 6.283185307179586);
  }
  Random random(seed, 0xE7);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::vector<float>* threshold : {&threshold_on_, &threshold_off_}) {
      const double factor = std::max(0.2, 1 + settings.threshold_spread * random.Gaussian());
      (*threshold)[i] = static_cast<float>(settings.threshold * factor);
    }
    // Where between its thresholds a pixel starts is chance: no wave of equal first events.
    stored_[i] = static_cast<float>(random.Uniform(-threshold_on_[i], threshold_off_[i]) * 0.999);
  }
}

void EventSensor::Start(int row_begin, int row_end, const float* image) {
  const std::size_t end = static_cast<std::size_t>(row_end) * width_;
  for (std::size_t i = static_cast<std::size_t>(row_begin) * width_; i < end; ++i) {
    input_[i] = level_[i] = FastLog(image[i] + dark_);
    stored_[i] += level_[i];
  }
}

float EventSensor::DriftAt(std::int32_t t) const {
  const auto wave = [&](int k) { return std::sin(drift_waves_[k] * t + drift_waves_[2 + k]); };
  return 1 + drift_ * static_cast<float>(wave(0) + wave(1));
}

// Exact answer of the low pass to an input that goes from input[x] to `now` in a straight line.
EVIT_MULTIVERSION void EventSensor::LowPass(const float* source, float* input, float* level, float dt) const {
  const float keep = std::exp(-dt / tau_us_), lag = tau_us_ / dt;
  for (int x = 0; x < width_; ++x) {
    const float now = FastLog(source[x] + dark_);
    const float delay = (now - input[x]) * lag;
    level[x] = now - delay + (level[x] - input[x] + delay) * keep;
    input[x] = now;
  }
}

// The same with a time constant for each pixel; exp(-z) as the reciprocal of the series of exp(z), which
// stays within 0..1 and 2 % of it where it matters (z below 2).
EVIT_MULTIVERSION void EventSensor::LowPassByLight(const float* source, float* input, float* level,
                                                   float dt) const {
  const float bright = bright_ + dark_;
  for (int x = 0; x < width_; ++x) {
    const float light = source[x] + dark_;
    const float tau = tau_us_ * std::max(1.0F, bright / light);
    const float z = dt / tau, keep = 1 / (1 + z * (1 + z * (0.5F + z * (1.0F / 6 + z * (1.0F / 24)))));
    const float now = FastLog(light);
    const float delay = (now - input[x]) * tau / dt;
    level[x] = now - delay + (level[x] - input[x] + delay) * keep;
    input[x] = now;
  }
}

EVIT_MULTIVERSION void EventSensor::Step(int row_begin, int row_end, const float* image, std::int32_t t0,
                                         std::int32_t t1, std::vector<Event>* events) {
  const float dt = static_cast<float>(t1 - t0), factor = DriftAt(t1), leak = leak_per_us_ * dt;
  std::vector<float> before(width_);
  for (int y = row_begin; y < row_end; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * width_;
    float* level = level_.data() + row;
    std::copy(level, level + width_, before.begin());
    if (bright_ > 0) {
      LowPassByLight(image + row, input_.data() + row, level, dt);
    } else {
      LowPass(image + row, input_.data() + row, level, dt);
    }
    float* stored = stored_.data() + row;
    if (leak > 0) {
      for (int x = 0; x < width_; ++x) stored[x] -= leak;
    }
    const float *on = threshold_on_.data() + row, *off = threshold_off_.data() + row;
    const std::int32_t* free_from = free_from_.data() + row;
    for (int x = 0; x < width_; ++x) {
      const float change = level[x] - stored[x];
      if ((change >= factor * on[x]) | (-change >= factor * off[x]) | (free_from[x] > t0)) {
        Fire(row + x, x, y, before[x], level[x], t0, t1, factor, events);
      }
    }
  }
}

void EventSensor::Fire(std::size_t i, int x, int y, float y0, float y1, std::int32_t t0, std::int32_t t1,
                       float factor, std::vector<Event>* events) {
  const float on = factor * threshold_on_[i], off = factor * threshold_off_[i];
  const float dt = static_cast<float>(t1 - t0), slope = (y1 - y0) / dt;
  std::int32_t from = t0;
  while (true) {
    if (free_from_[i] > from) {
      if (free_from_[i] >= t1) {
        stored_[i] = y1;
        return;
      }
      from = free_from_[i];
      stored_[i] = y0 + slope * static_cast<float>(from - t0);
    }
    const float change = y1 - stored_[i];
    const bool up = change >= on, down = -change >= off;
    if (!up && !down) return;
    stored_[i] += up ? on : -off;
    const float offset = slope != 0 ? (stored_[i] - y0) / slope : dt;
    const std::int32_t t =
        std::clamp(t0 + static_cast<std::int32_t>(std::ceil(offset)), std::max(from, t0 + 1), t1);
    events->push_back({t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                       static_cast<std::uint8_t>(up ? 1 : 0)});
    free_from_[i] = t + refractory_us_;
  }
}

void SortByTime(std::int32_t t0, std::int32_t t1, std::vector<EventSensor::Event>* events) {
  std::vector<std::size_t> place(static_cast<std::size_t>(t1 - t0) + 2, 0);
  for (const EventSensor::Event& event : *events) ++place[event.t - t0 + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<EventSensor::Event> sorted(events->size());
  for (const EventSensor::Event& event : *events) sorted[place[event.t - t0]++] = event;
  events->swap(sorted);
}

}  // namespace evit::simulation
