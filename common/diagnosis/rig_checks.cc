#include "common/diagnosis/rig_checks.h"

#include <cmath>

#include "common/geometry/degrees.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

Finding Intrinsics(const Camera& c) {
  const double view = 2 * kDegreesPerRadian * std::atan(c.width / (2 * c.fx));
  const double scale_x = 2 * c.cx / c.width, scale_y = 2 * c.cy / c.height;
  const std::string figure =
      FormatText("%dx%d, %.0f deg wide, centre at (%.0f, %.0f)", c.width, c.height, view, c.cx, c.cy);
  // Off the middle in both directions alike: a scaled image. In one alone: a part of the sensor.
  const bool scaled = std::abs(scale_x / scale_y - 1) < 0.15 && (scale_x < 0.75 || scale_x > 1.35);
  if (scaled || c.cx >= c.width || c.cy >= c.height) {
    return {"intrinsics", Severity::kError, figure,
            FormatText("The principal point is far from the middle of the image: the intrinsics are those of "
                       "about %.0fx%.0f pixels.",
                       2 * c.cx, 2 * c.cy),
            "scale fx, fy, cx and cy with the image, or calibrate at the resolution that is recorded"};
  }
  if (std::abs(c.fx / c.fy - 1) > 0.1) {
    return {"intrinsics", Severity::kWarning, figure,
            "fx and fy differ by more than a tenth: pixels are square on every event camera.",
            "look at fx and fy in the rig file"};
  }
  if (view < 15 || view > 150) {
    return {"intrinsics", Severity::kWarning, figure, "The field of view is unusual.",
            "look at fx and width in the rig file"};
  }
  return Good("intrinsics", figure);
}

// Largest of the axes; nothing where the rig file says nothing.
std::string KnownText(const ExtrinsicsSigma& sigma) {
  const double degrees = kDegreesPerRadian * sigma.rotation.maxCoeff();
  const double mm = 1e3 * sigma.translation.maxCoeff();
  std::string text;
  if (degrees > 0) text = FormatText("%.2f deg", degrees);
  if (mm > 0) text += (text.empty() ? "" : " and ") + FormatText("%.1f mm", mm);
  return text.empty() ? text : ", known to " + text;
}

Finding Extrinsics(const Rig& rig) {
  const double distance = rig.T_body_camera.p.norm();
  const std::string figure =
      FormatText("camera %.1f cm from the IMU", 100 * distance) + KnownText(rig.T_body_camera_sigma);
  if (distance > 0.6) {
    return {"extrinsics", distance > 3 ? Severity::kError : Severity::kWarning, figure,
            FormatText("T_body_camera puts the camera %.3g m from the IMU.", distance),
            distance > 3 ? "give its translation in metres"
                         : "look at T_body_camera in the rig file: metres, camera to body"};
  }
  return Good("extrinsics", figure);
}

Finding TimeOffset(const Rig& rig) {
  const double ms = 1e3 * ToSeconds(rig.camera_time_offset);
  const std::string figure = FormatText("%.3f ms to add to event stamps", ms);
  if (std::abs(ms) > 0.2e3) {
    return {"rig-time-offset", Severity::kWarning, figure, "The rig file's time offset is longer than 0.2 s.",
            "time_offset_us is in microseconds: Kalibr's timeshift_cam_imu (seconds) times 1e6"};
  }
  return Good("rig-time-offset", figure);
}

}  // namespace

Findings CheckRig(const Rig& rig) { return {Intrinsics(rig.camera), Extrinsics(rig), TimeOffset(rig)}; }

}  // namespace evit::diagnosis
