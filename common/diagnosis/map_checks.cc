#include "common/diagnosis/map_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/geometry/degrees.h"
#include "common/geometry/so3.h"
#include "common/map/map_file.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kFarStart = 0.5, kTurnedStart = 25;  // m, deg

Finding Unit(const MapSummary& s) {
  const double extent = (s.max - s.min).maxCoeff();
  const std::string figure =
      FormatText("%zu points, %.3g m across, %.2g m apart", s.n_points, extent, s.median_spacing);
  if (s.n_points < 500) {
    return {"map-size", s.n_points < 200 ? Severity::kError : Severity::kWarning, figure,
            FormatText("The map has only %zu points: a camera sees too few of them at a time.", s.n_points),
            "make one from camera frames: `evit map build`"};
  }
  // What a camera sees of a room or a street is between these, and a semi-dense map has its edges sampled
  // finely.
  if (s.median_spacing > 0.5 || extent > 3000) {
    return {"map-unit", Severity::kError, figure,
            "The map is too large for metres: it is in millimetres or centimetres, or far from its origin.",
            "convert it: `evit map import MAP --scale 0.001 --out metres.pcd` (or 0.01)"};
  }
  if (extent < 0.2) {
    return {"map-unit", Severity::kError, figure, "The map is smaller than a hand: its unit is not metres.",
            "convert it: `evit map import MAP --scale FACTOR --out metres.pcd`"};
  }
  if (s.median_spacing > 0.1) {
    return {"map-spacing", Severity::kWarning, figure, "The map's points are far apart.",
            "make a denser one; a centimetre or two is usual"};
  }
  return Good("map-unit", figure);
}

Finding View(const MapIndex& map, const Rig& rig, const SE3& start) {
  VisibilityQuery query;
  query.T_map_camera = start * rig.T_body_camera;
  query.camera = rig.camera;
  const int visible = map.Query(query).n_visible;
  const std::string figure = FormatText("%d map points in view of the start pose", visible);
  const MapSummary s = Summarize(map.map());
  const Eigen::Vector3d low = s.min.cast<double>(), high = s.max.cast<double>();
  const Eigen::Vector3d nearest = start.p.cwiseMax(low).cwiseMin(high);
  if (visible < 100) {
    const double away = (nearest - start.p).norm();
    return {
        "start-view", Severity::kError, figure,
        away > 3
            ? FormatText(
                  "The start pose is %.1f m outside the map: it is in another frame, or another map's.", away)
            : "From the start pose the camera sees almost nothing of the map: it looks elsewhere, or "
              "T_body_camera is "
              "turned.",
        "give the pose of the IMU in the map (x y z qx qy qz qw), or none: EVIT then looks for it"};
  }
  return Good("start-view", figure);
}

// A start is searched for around the given pose, but not further.
Finding Known(const SE3& start, const SE3& known) {
  const double away = (start.p - known.p).norm(),
               turned = kDegreesPerRadian * AngularDistance(start.q, known.q);
  const std::string figure = FormatText("start pose %.0f cm and %.0f deg off the truth", 100 * away, turned);
  if (away < kFarStart && turned < kTurnedStart) return Good("start-pose", figure);
  return {"start-pose", Severity::kError, figure,
          FormatText("The start pose is %.2f m and %.0f deg off where the truth begins.", away, turned),
          "give the pose of the IMU in the map at the beginning of the recording, or none: EVIT then looks "
          "for it"};
}

Finding Upright(const SE3& start, const std::vector<ImuSample>& imu) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& s : imu)
    if (s.t < imu.front().t + 500'000) sum += s.accel;
  const double tilt = kDegreesPerRadian * std::acos(std::clamp((start.q * sum).normalized().z(), -1.0, 1.0));
  const std::string figure = FormatText("gravity %.0f deg off the map's z axis at the start pose", tilt);
  // Hands accelerate a rig by 2 m/s^2 and more: 12 degrees.
  if (tilt > 25) {
    return {"start-tilt", Severity::kError, figure,
            tilt > 150
                ? "At the start pose gravity points up: the pose or the map is upside down, or the "
                  "accelerometer's sign is turned."
                : "At the start pose gravity does not point down: pose, map or T_body_camera is turned.",
            "the map's z axis must be up (`evit map import --transform`), and the pose the IMU's, not the "
            "camera's"};
  }
  return Good("start-tilt", figure);
}

}  // namespace

Findings CheckMap(const PointMap& map) { return {Unit(Summarize(map))}; }

Findings CheckStart(const MapIndex& map, const Rig& rig, const SE3& start, const std::vector<ImuSample>& imu,
                    const std::optional<SE3>& known) {
  Findings found{View(map, rig, start)};
  if (known) found.push_back(Known(start, *known));
  if (imu.size() > 20) found.push_back(Upright(start, imu));
  return found;
}

}  // namespace evit::diagnosis
