#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/events/event.h"

namespace evit::simulation {

struct EventSensorSettings {
  double threshold = 0.33;         // of log intensity
  double threshold_spread = 0.12;  // standard deviation over pixels and polarities, share of the threshold
  double low_pass_ms = 0.4;        // time constant of the photoreceptor
  double refractory_ms = 0.2;
  double noise_hz = 0.6;  // background events per pixel
  int hot_pixels = 12;
  double hot_min_hz = 200, hot_max_hz = 800;
  double dark = 3;  // grey added before the logarithm (dark current)
  // What profiles beyond `ideal` have.
  double bright_grey = 0;      // grey at which low_pass_ms holds, darker pixels are slower; 0: all alike
  double threshold_drift = 0;  // standard deviation of all thresholds together over seconds, share
  double leak_hz = 0;          // brighter events of a pixel that sees no change
};

/// Natural logarithm, error below 1e-4: fast in vector code.
float FastLog(float x);

/// An event camera's pixels (after Hu et al., "v2e", 2021, and Rebecq et al., "ESIM", 2018): light -> log ->
/// first-order low pass -> change detector against a stored level, with refractory time and fixed-pattern
/// thresholds. Between two images log intensity changes linearly. After an event the stored level is the
/// threshold that was crossed; while refractory the pixel is held in reset, its stored level follows the
/// input.
///
/// Where `bright_grey` is set, the time constant is inverse to the light, as a photoreceptor's bandwidth is
/// proportional to its photocurrent (v2e, Sec. 3). Leaks lower the stored level at an even rate (v2e, Sec.
/// 4).
class EventSensor {
 public:
  struct Event {
    std::int32_t t;  // us since the first image
    std::uint16_t x, y;
    std::uint8_t p;
  };

  EventSensor(int width, int height, const EventSensorSettings& settings, std::uint64_t seed);

  /// Rows [row_begin, row_end) of the first image (grey, linear; whole image given), at time 0.
  void Start(int row_begin, int row_end, const float* image);

  /// The same rows at t1, after t0 (us since the first image): appends events in (t0, t1], row by row, in
  /// order of time within a pixel. Different rows may be stepped by different threads.
  void Step(int row_begin, int row_end, const float* image, std::int32_t t0, std::int32_t t1,
            std::vector<Event>* events);

 private:
  void LowPass(const float* source, float* input, float* level, float dt) const;
  void LowPassByLight(const float* source, float* input, float* level, float dt) const;
  float DriftAt(std::int32_t t) const;
  void Fire(std::size_t i, int x, int y, float y0, float y1, std::int32_t t0, std::int32_t t1, float factor,
            std::vector<Event>* events);

  int width_, height_;
  float dark_, tau_us_;
  std::int32_t refractory_us_;
  float bright_, leak_per_us_;
  float drift_;
  std::array<double, 4> drift_waves_{};  // two rates (rad/us), two phases
  std::vector<float> input_, level_,
      stored_;  // log intensity: newest input, low-passed, stored by the detector
  std::vector<float> threshold_on_, threshold_off_;
  std::vector<std::int32_t> free_from_;  // end of the refractory time
};

/// Sorts by time, keeping the given order among equal stamps; all stamps in (t0, t1].
void SortByTime(std::int32_t t0, std::int32_t t1, std::vector<EventSensor::Event>* events);

}  // namespace evit::simulation
