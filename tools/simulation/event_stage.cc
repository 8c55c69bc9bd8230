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

// One camera at work, batch by batch: views are rendered, its pixels turn them into events, noise and readout
// follow.
class EventStage {
 public:
  EventStage(const Renderer& renderer, const PoseSpline& motion, const Rig& rig,
             const RenderSchedule& schedule, const Disturbances& disturbances, const CameraSettings& settings,
             std::uint64_t seed, int threads)
      : renderer_(renderer),
        motion_(motion),
        rig_(rig),
        times_(schedule.times),
        disturbances_(disturbances),
        settings_(settings),
        threads_(threads),
        sensor_(renderer.camera().width, renderer.camera().height, settings.sensor, seed),
        noise_(renderer.camera().width, renderer.camera().height, settings.sensor, seed),
        readout_(settings.readout, seed),
        views_(kBatch),
        steps_(static_cast<std::size_t>(kBands) * kBatch) {}

  int n() const { return static_cast<int>(times_.size()); }
  /// Events of `count` renders from `first` on.
  void Process(int first, int count, EventArray* out) {
    ParallelFor(count, threads_, [&](int k) { Render(times_[first + k], &views_[k]); });
    ParallelFor(kBands, threads_, [&](int band) { Sense(band, first, count); });
    out->clear();
    for (int k = first == 0 ? 1 : 0; k < count; ++k) ReadOut(first, k, out);
  }
  EventCounts counts() const {
    EventCounts counts = counts_;
    counts.lost = readout_.lost();
    return counts;
  }

 private:
  // From the first render; us.
  std::int32_t Relative(int k) const { return static_cast<std::int32_t>(times_[k] - times_.front()); }

  void Render(Utime t, View* view) const {
    std::vector<Surface> moving;
    if (disturbances_.box) moving = disturbances_.box->At(t);
    renderer_.Render(motion_.Pose(t) * rig_.T_body_camera, view, moving);
    const auto light = static_cast<float>(disturbances_.lamp.Factor(t) * disturbances_.cover.Factor(t));
    if (light != 1) {
      for (float& pixel : view->image) pixel *= light;
    }
    ApplyOptics(settings_.optics, renderer_.camera().width, renderer_.camera().height, &view->image);
  }

  // The batch, in one band of rows.
  void Sense(int band, int first, int count) {
    const int height = renderer_.camera().height;
    const int row_begin = band * height / kBands, row_end = (band + 1) * height / kBands;
    for (int k = 0; k < count; ++k) {
      const float* image = views_[k].image.data();
      std::vector<EventSensor::Event>& step = steps_[static_cast<std::size_t>(k) * kBands + band];
      step.clear();
      if (first + k == 0) {
        sensor_.Start(row_begin, row_end, image);
      } else {
        sensor_.Step(row_begin, row_end, image, Relative(first + k - 1), Relative(first + k), &step);
      }
    }
  }

  // All bands' events up to the batch's k-th render.
  void ReadOut(int first, int k, EventArray* out) {
    std::vector<EventSensor::Event> step;
    for (int band = 0; band < kBands; ++band) {
      const auto& part = steps_[static_cast<std::size_t>(k) * kBands + band];
      step.insert(step.end(), part.begin(), part.end());
    }
    const std::size_t before = step.size();
    noise_.Until(Relative(first + k), &step);
    counts_.noise += step.size() - before;
    SortByTime(Relative(first + k - 1), Relative(first + k), &step);
    readout_.Pass(Relative(first + k), &step);
    for (const EventSensor::Event& event : step) {
      out->push_back(times_.front() + event.t, event.x, event.y, event.p);
      ++(event.p ? counts_.positive : counts_.negative);
      meter_.Add(event.t, &counts_);
    }
  }

  const Renderer& renderer_;
  const PoseSpline& motion_;
  const Rig& rig_;
  const std::vector<Utime>& times_;
  const Disturbances& disturbances_;
  const CameraSettings& settings_;
  int threads_;
  EventSensor sensor_;
  NoiseSource noise_;
  Readout readout_;
  std::vector<View> views_;                             // of the batch
  std::vector<std::vector<EventSensor::Event>> steps_;  // [render of the batch][band]
  EventCounts counts_;
  PeakMeter meter_;
};

}  // namespace

EventCounts SimulateEvents(const Renderer& renderer, const PoseSpline& motion, const Rig& rig,
                           const RenderSchedule& schedule, const Disturbances& disturbances,
                           const CameraSettings& settings, std::uint64_t seed, int threads,
                           const std::function<void(const EventArray&)>& sink,
                           const std::function<void(double)>& progress) {
  EventStage stage(renderer, motion, rig, schedule, disturbances, settings, seed, threads);
  EventArray out;
  for (int first = 0; first < stage.n(); first += kBatch) {
    const int count = std::min(kBatch, stage.n() - first);
    stage.Process(first, count, &out);
    sink(out);
    if (progress) progress(static_cast<double>(first + count) / stage.n());
  }
  return stage.counts();
}

}  // namespace evit::simulation
