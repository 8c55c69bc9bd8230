#include "tools/calibration/overlap_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/calibration/calibrated_sigma.h"
#include "common/geometry/degrees.h"
#include "common/map/map_file.h"
#include "common/text/format_text.h"
#include "tools/calibration/recorded_events.h"

namespace evit::calibration {
namespace {

constexpr Utime kStep = 33'000;
constexpr Utime kMostViews = 300;  // fields of VGA: 100 MB
constexpr double kMarginPx = 60;   // an extrinsic error of some degrees leaves it in view
// Slices twice as long as where sharp edges are asked for: errors of stamps matter less, and what moves to
// both sides of a view cancels.
constexpr double kSlicePx = 6;
constexpr Utime kLongest = 80'000;
constexpr char kAxes[] = "xyz";

std::string Sentence(const Unobservable& u) {
  if (u.value == Unobservable::Value::kTimeOffset) {
    return FormatText(
        "time offset, known to %.1f ms only: the value of the rig file is kept; turn faster, this way and "
        "that",
        1e3 * u.sigma);
  }
  return FormatText(
      "rotation about (%.2f, %.2f, %.2f) of the camera, known to %.1f deg only: the value of the rig file is "
      "kept; "
      "have more of the map in view",
      u.direction.x(), u.direction.y(), u.direction.z(), kDegreesPerRadian * u.sigma);
}

struct Row {
  std::string name;
  double before, after, sigma;
};

std::vector<Row> Rows(const Rig& before, const OverlapCalibration& c) {
  const auto sigma = [&](int k) { return std::sqrt(c.covariance(k, k)); };
  const Eigen::Vector3d turn =
      kDegreesPerRadian * LogSO3(before.T_body_camera.q.conjugate() * c.T_body_camera.q);
  std::vector<Row> rows;
  rows.reserve(7);
  for (int k = 0; k < 3; ++k) {
    rows.push_back({FormatText("T_body_camera %c [mm]", kAxes[k]), 1e3 * before.T_body_camera.p[k],
                    1e3 * c.T_body_camera.p[k], 1e3 * sigma(k)});
  }
  for (int k = 0; k < 3; ++k)
    rows.push_back({FormatText("turned about the camera's %c [deg]", kAxes[k]), 0, turn[k],
                    kDegreesPerRadian * sigma(3 + k)});
  rows.push_back({"camera.time_offset_us [ms]", 1e3 * ToSeconds(before.camera_time_offset),
                  1e3 * ToSeconds(c.offset), 1e3 * sigma(6)});
  return rows;
}

std::string OverlapLine(const char* name, const MapEventOverlap& o) {
  const Eigen::Vector2d offset = o.mean_offset();
  return FormatText(
      "%-12s points with events within 2 px %5.1f %% (%.1f %% by chance), events within 2 px of the map "
      "%5.1f %% "
      "(%.1f %%), mean offset %.2f, %.2f px\n",
      name, 100 * o.point_share(), 100 * o.point_share_by_chance(), 100 * o.event_share(),
      100 * o.event_share_by_chance(), offset.x(), offset.y());
}

}  // namespace

Trajectory ReadTruth(const OverlapFiles& files) {
  Trajectory body = ReadTum(files.truth);
  if (files.seconds && !body.empty()) {
    const Utime first = body.front().t, begin = first + std::llround(1e6 * files.seconds->first),
                end = first + std::llround(1e6 * files.seconds->second);
    body.erase(std::remove_if(body.begin(), body.end(),
                              [&](const StampedPose& s) { return s.t < begin || s.t > end; }),
               body.end());
  }
  if (body.size() < 2)
    throw std::runtime_error(files.truth + ": holds fewer than two poses of the part asked for");
  return body;
}

MapViewOptions CalibrationViews() {
  MapViewOptions options;
  options.margin_px = kMarginPx;
  options.slice_px = kSlicePx;
  options.longest = kLongest;
  return options;
}

std::vector<MapView> ReadViews(const OverlapFiles& files, const Rig& rig, const Trajectory& body,
                               MapViewOptions options, const std::function<void()>& between_packets) {
  options.step = std::max(kStep, (body.back().t - body.front().t) / kMostViews);
  std::vector<MapView> views = PlanViews(MapIndex(LoadMap(files.map).map), rig, body, options);
  if (views.empty()) {
    throw std::runtime_error(
        files.map + ": no pose of " + files.truth +
        " has it in view; are both in one frame, in metres, and the poses those of the body?");
  }
  ViewFiller filler(&views);
  ForEachEventPacket(files.log, views.front().begin, views.back().end, [&](const EventArray& events) {
    if (between_packets) between_packets();
    filler.AddEvents(events);
  });
  if (std::all_of(views.begin(), views.end(), [](const MapView& v) { return v.n_events == 0; })) {
    throw std::runtime_error(files.log + ": has no events at the times of " + files.truth +
                             "; are both of one recording and one clock?");
  }
  return views;
}

Rig Calibrated(const Rig& before, const OverlapCalibration& c) {
  Rig rig = before;
  rig.T_body_camera = c.T_body_camera;
  rig.T_body_camera_sigma =
      CalibratedSigma(c.covariance.topLeftCorner<6, 6>(), c.unobservable, before.T_body_camera_sigma);
  rig.camera_time_offset = c.offset;
  return rig;
}

std::string OverlapText(const Rig& before, const OverlapCalibration& c) {
  std::string text = FormatText("%lld views\n\n%-34s %10s %12s %10s\n", static_cast<long long>(c.after.views),
                                "", "rig file", "calibrated", "sigma");
  for (const Row& row : Rows(before, c))
    text += FormatText("%-34s %10.3f %12.3f %10.3f\n", row.name.c_str(), row.before, row.after, row.sigma);
  text += FormatText("camera turned by %.2f deg and moved by %.1f mm\n\n",
                     kDegreesPerRadian * AngularDistance(before.T_body_camera.q, c.T_body_camera.q),
                     1e3 * (before.T_body_camera.p - c.T_body_camera.p).norm());
  text += OverlapLine("rig file:", c.before) + OverlapLine("calibrated:", c.after);
  for (const Unobservable& u : c.unobservable)
    text += "NOT OBSERVABLE from this motion: " + Sentence(u) + "\n";
  return text;
}

std::string OverlapRigComment(const Rig& before, const OverlapCalibration& c, const std::string& sources) {
  std::string text =
      "T_body_camera, its standard deviations and camera.time_offset_us by evit calibrate --truth; all other "
      "values are unchanged.\n" +
      sources + "\n";
  for (const Row& row : Rows(before, c))
    text +=
        FormatText("  %s: %.3f, was %.3f, sigma %.3f\n", row.name.c_str(), row.after, row.before, row.sigma);
  for (const Unobservable& u : c.unobservable) text += "not observable: " + Sentence(u) + "\n";
  return text;
}

}  // namespace evit::calibration
