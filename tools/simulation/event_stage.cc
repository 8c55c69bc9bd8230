#include "tools/simulation/event_stage.h"

#include <algorithm>

#include "common/parallel/parallel_for.h"
#include "tools/simulation/noise_source.h"

namespace evit::simulation {
namespace {

constexpr int kBatch = 16;  // images rendered side by side, then run through the sensor
constexpr int kBands = 16;  // groups of rows of the sensor

// Counts events in consecutive 10 ms.
class PeakMeter {
 public:
  void Add(std::int32_t t, EventCounts* counts) {
    constexpr std::int32_t kWindow = 10'000;
    if (t / kWindow != window_) {
      window_ = t / kWindow;
      count_ = 0;
    }
    counts->peak_rate = std::max(counts->peak_rate, ++count_ * (1e6 / kWindow));
  }

 private:
  std::int32_t window_ = 0;
  double count_ = 0;
};

}  // namespace

EventCounts SimulateEvents(const Renderer& renderer, const PoseSpline& motion, const Rig& rig,
                           const RenderSchedule& schedule, const Disturbances& disturbances,
                           const CameraSettings& settings, std::uint64_t seed, int threads,
                           const std::function<void(const EventArray&)>& sink,
                           const std::function<void(double)>& progress) {
  const int width = renderer.camera().width, height = renderer.camera().height;
  EventSensor sensor(width, height, settings.sensor, seed);
  NoiseSource noise(width, height, settings.sensor, seed);
  Readout readout(settings.readout, seed);
  const Utime begin = schedule.times.front();
  const auto relative = [&](int k) { return static_cast<std::int32_t>(schedule.times[k] - begin); };
  std::vector<View> views(kBatch);
  EventCounts counts;
  PeakMeter meter;
  EventArray out;
  const int n = static_cast<int>(schedule.times.size());
  for (int first = 0; first < n; first += kBatch) {
    const int count = std::min(kBatch, n - first);
    ParallelFor(count, threads, [&](int k) {
      const Utime t = schedule.times[first + k];
      std::vector<Surface> moving;
      if (disturbances.box) moving = disturbances.box->At(t);
      renderer.Render(motion.Pose(t) * rig.T_body_camera, &views[k], moving);
      const auto light = static_cast<float>(disturbances.lamp.Factor(t) * disturbances.cover.Factor(t));
      if (light != 1) {
        for (float& pixel : views[k].image) pixel *= light;
      }
      ApplyOptics(settings.optics, width, height, &views[k].image);
    });
    std::vector<std::vector<EventSensor::Event>> events(static_cast<std::size_t>(kBands) * kBatch);
    ParallelFor(kBands, threads, [&](int band) {
      const int row_begin = band * height / kBands, row_end = (band + 1) * height / kBands;
      for (int k = 0; k < count; ++k) {
        const float* image = views[k].image.data();
        if (first + k == 0) {
          sensor.Start(row_begin, row_end, image);
        } else {
          sensor.Step(row_begin, row_end, image, relative(first + k - 1), relative(first + k),
                      &events[static_cast<std::size_t>(k) * kBands + band]);
        }
      }
    });
    out.clear();
    for (int k = first == 0 ? 1 : 0; k < count; ++k) {
      std::vector<EventSensor::Event> step;
      for (int band = 0; band < kBands; ++band) {
        const auto& part = events[static_cast<std::size_t>(k) * kBands + band];
        step.insert(step.end(), part.begin(), part.end());
      }
      const std::size_t before = step.size();
      noise.Until(relative(first + k), &step);
      counts.noise += step.size() - before;
      SortByTime(relative(first + k - 1), relative(first + k), &step);
      readout.Pass(relative(first + k), &step);
      for (const EventSensor::Event& event : step) {
        out.push_back(begin + event.t, event.x, event.y, event.p);
        ++(event.p ? counts.positive : counts.negative);
        meter.Add(event.t, &counts);
      }
    }
    sink(out);
    if (progress) progress(static_cast<double>(first + count) / n);
  }
  counts.lost = readout.lost();
  return counts;
}

}  // namespace evit::simulation
