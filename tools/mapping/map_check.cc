#include "tools/mapping/map_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <tuple>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "common/text/words.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"
#include "tools/mapping/check_findings.h"
#include "tools/mapping/gravity_direction.h"

namespace evit::mapping {
namespace {

// Reads the log once: events into the views, and where gravity points in the map.
class LogPass {
 public:
  LogPass(const Trajectory& truth, std::vector<MapView>* views) : gravity(truth), filler_(views) {}

  void Read(const LogReader& log, const std::function<void(double)>& progress) {
    std::vector<std::uint8_t> bytes;
    const auto& entries = log.entries();
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const std::string& channel = log.channel(entries[k]);
      if (k % 64 == 0) progress(static_cast<double>(k) / static_cast<double>(entries.size()));
      if (EndsWith(channel, "EVENTS")) {
        log.Read(entries[k], &bytes);
        Take<event_packet_t>(bytes, [&](const event_packet_t& packet) {
          EventArray events;
          AppendEvents(packet, &events);
          if (events.t.empty()) return;
          if (n_events == 0) first = events.t.front();
          last = events.t.back();
          n_events += events.size();
          filler_.AddEvents(events);
        });
      } else if (EndsWith(channel, "IMU")) {
        log.Read(entries[k], &bytes);
        Take<imu_batch_t>(bytes, [&](const imu_batch_t& batch) {
          for (const ImuSample& s : SamplesOf(batch)) gravity.Add(s);
        });
      }
    }
  }

  std::size_t n_events = 0;
  Utime first = 0, last = 0;
  GravityMean gravity;

 private:
  template <typename Message, typename Use>
  static void Take(const std::vector<std::uint8_t>& bytes, const Use& use) {
    Message message;
    if (DecodeChecked(bytes.data(), bytes.size(), &message)) use(message);
  }

  ViewFiller filler_;
};

// Which parts of the map were in view, and never fired.
void CountCells(const PointMap& map, const Rig& rig, MapCheck* check) {
  using Cell = std::tuple<int, int, int>;
  struct Count {
    int seen = 0, fired = 0, last = -1;
  };
  const auto cell = [](const Eigen::Vector3f& p) {
    const auto part = [](float v) { return static_cast<int>(std::floor(v / 0.05F)); };
    return Cell(part(p.x()), part(p.y()), part(p.z()));
  };
  std::map<Cell, Count> cells;
  for (const Eigen::Vector3f& p : map.points) cells[cell(p)];
  const NearestPixel near(OverlapOptions().radius_px);
  for (int k = 0; k < static_cast<int>(check->views.size()); ++k) {
    const MapView& view = check->views[k];
    const SE3 T = (view.T_map_body * rig.T_body_camera).Inverse();
    for (const Eigen::Vector3f& p : view.points) {
      Eigen::Vector2d pixel, offset;
      if (!rig.camera.Project(T * p.cast<double>(), &pixel) || !rig.camera.Contains(pixel, 4)) continue;
      Count& count = cells[cell(p)];
      if (count.last != k) ++count.seen, count.last = k;
      if (near.Find(view.fired, pixel, &offset)) ++count.fired;
    }
  }
  check->cells = cells.size();
  for (const auto& [key, count] : cells) {
    if (count.seen < 5) continue;
    ++check->cells_seen;
    if (count.fired == 0) ++check->cells_silent;
  }
}

// Instants at which PlanViews looks whether the map is in view.
std::size_t CountMoments(const Trajectory& truth, const MapViewOptions& options) {
  std::size_t n = 0;
  SE3 pose;
  for (Utime t = truth.front().t + options.longest; t + options.longest <= truth.back().t; t += options.step)
    n += PoseAt(truth, t, &pose) ? 1 : 0;
  return n;
}

std::string Span(Utime from, Utime to) {
  char text[80];
  std::snprintf(text, sizeof text, "%.3f to %.3f s", static_cast<double>(from) * 1e-6,
                static_cast<double>(to) * 1e-6);
  return text;
}

}  // namespace

MapCheck CheckMap(const MapCheckInputs& inputs, const std::function<void(double)>& progress) {
  const Rig rig = LoadRig(inputs.rig);
  const Trajectory truth = ReadTum(inputs.truth);
  if (truth.size() < 2) throw std::runtime_error(inputs.truth + ": holds fewer than two poses");
  const MapIndex index(LoadMap(inputs.map).map);
  const LogReader log(inputs.log);
  MapCheck check;
  MapViewOptions options;
  options.max_points = 50'000;  // of fewer than all, pixels that fire would seem to be off the map
  options.step = std::max<Utime>(100'000, (truth.back().t - truth.front().t) / 100);
  check.views = PlanViews(index, rig, truth, options);
  check.moments_planned = CountMoments(truth, options);
  LogPass pass(truth, &check.views);
  pass.Read(log, [&](double share) { progress(0.6 * share); });
  if (pass.n_events == 0) throw std::runtime_error(inputs.log + ": holds no events (channel EVENTS)");
  if (pass.last < truth.front().t || pass.first > truth.back().t) {
    throw std::runtime_error(inputs.truth + ": is of " + Span(truth.front().t, truth.back().t) +
                             ", the events of " + inputs.log + " of " + Span(pass.first, pass.last) +
                             ": another recording's truth, or another clock");
  }
  const auto before = check.views.size();
  const auto empty = [](const MapView& view) { return view.n_events == 0; };
  check.views.erase(std::remove_if(check.views.begin(), check.views.end(), empty), check.views.end());
  check.moments_planned -= std::min(check.moments_planned, before - check.views.size());
  if (check.views.empty()) {
    throw std::runtime_error(
        inputs.map + ": at the poses of " + inputs.truth +
        " the camera never sees the map: another frame (poses must be of the body, in the map's frame: evit "
        "import writes LOG.truth.tum), or another unit (evit map info " +
        inputs.map + ")");
  }
  for (const MapView& view : check.views) {
    check.moments.push_back(MeasureOverlap(rig.camera, view.T_map_body * rig.T_body_camera, view));
    check.overlap.Add(check.moments.back());
  }
  progress(0.7);
  check.point_share = PointShare(rig, truth, check.views);
  check.fits = FindMisplacements(rig, truth, check.views);
  SortByMerit(&check.fits);
  check.corrected = MeasureCorrected(rig, truth, check.views, check.fits.front());
  CountCells(index.map(), rig, &check);
  check.has_imu = pass.gravity.n() > 100;
  check.tilt_deg = check.has_imu ? pass.gravity.TiltDegrees() : 0;
  check.findings = Findings(inputs, check);
  progress(1);
  return check;
}

}  // namespace evit::mapping
