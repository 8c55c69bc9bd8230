#include "common/diagnosis/assumptions.h"

#include <cmath>

#include "common/geometry/degrees.h"
#include "common/geometry/so3.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

SE3 Turn(double degrees, const Eigen::Vector3d& axis) {
  return {ExpSO3(degrees / kDegreesPerRadian * axis), Eigen::Vector3d::Zero()};
}

void MovePoses(World* world, const std::function<SE3(const SE3&)>& change) {
  for (StampedPose& s : world->truth) s.pose = change(s.pose);
}

// What a pose transforms is easily taken the wrong way round, or of the wrong body.
void AddConventions(std::vector<Assumption>* all) {
  all->push_back({"T_body_camera is inverted",
                  "put the inverse into the rig file: it maps the camera's coordinates to the body's (Kalibr "
                  "gives T_cam_imu)",
                  [](World* w) { w->rig.T_body_camera = w->rig.T_body_camera.Inverse(); }});
  all->push_back({"The truth is the camera's, not the IMU's",
                  "give poses of the IMU: T_map_camera times the inverse of T_body_camera", [](World* w) {
                    const SE3 back = w->rig.T_body_camera.Inverse();
                    MovePoses(w, [&back](const SE3& pose) { return pose * back; });
                  }});
  all->push_back({"The truth maps the map to the body, not the body to the map",
                  "invert the poses of the truth",
                  [](World* w) { MovePoses(w, [](const SE3& pose) { return pose.Inverse(); }); }});
  all->push_back({"The truth is a marker body's, not the IMU's",
                  "import the truth with this rig file, whose T_marker_body turns it into the IMU's",
                  [](World* w) {
                    const SE3 marker = w->rig.T_marker_body;
                    MovePoses(w, [&marker](const SE3& pose) { return pose * marker; });
                  }});
}

void AddImages(std::vector<Assumption>* all) {
  for (const bool x : {true, false}) {
    for (const bool y : {true, false}) {
      if (!x && !y) continue;
      all->push_back({x && y ? "The image is upside down"
                      : x    ? "The image is mirrored left to right"
                             : "The image is mirrored top to bottom",
                      "turn the flip off in the driver, or turn the coordinates of the events around",
                      [x, y](World* w) { w->mirror_x = x, w->mirror_y = y; }});
    }
  }
  for (const double scale : {0.5, 2.0}) {
    all->push_back({"The intrinsics are for another resolution",
                    FormatText("multiply fx, fy, cx and cy by %.1f", scale), [scale](World* w) {
                      Camera& c = w->rig.camera;
                      c.fx *= scale, c.fy *= scale, c.cx = (c.cx + 0.5) * scale - 0.5,
                                                    c.cy = (c.cy + 0.5) * scale - 0.5;
                    }});
  }
}

void AddClocks(const Rig& rig, std::vector<Assumption>* all) {
  for (const double ms : {5.0, 10.0, 20.0, 40.0, 80.0, -5.0, -10.0, -20.0, -40.0, -80.0}) {
    all->push_back(
        {FormatText("The camera's clock is some %.0f ms off", ms),
         FormatText("set `time_offset_us: %.0f` in the rig file, then let `evit calibrate` find it exactly",
                    static_cast<double>(rig.camera_time_offset) + 1e3 * ms),
         [ms](World* w) { w->rig.camera_time_offset += std::llround(1e3 * ms); }, "time-offset",
         // By less than that pixels in dim light are late, and a slow image hardly tells.
         std::abs(ms) >= 40 ? 1.2 : 1.3});
  }
}

// The principal point that would do nearly the same as a small turn.
std::string OrCentre(const Rig& rig, double degrees, char axis) {
  if (axis == 'z') return "";
  const double focal = axis == 'x' ? rig.camera.fy : rig.camera.fx;
  return FormatText(", or %s by some %.0f pixels", axis == 'x' ? "cy" : "cx",
                    focal * std::tan(std::abs(degrees) / kDegreesPerRadian));
}

// Right angles by convention, small ones by hand.
void AddTurns(const Rig& rig, std::vector<Assumption>* all) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    const char name = axis.x() > 0 ? 'x' : axis.y() > 0 ? 'y' : 'z';
    for (const double degrees : {90.0, -90.0, 180.0}) {
      all->push_back(
          {FormatText("The map is turned by %.0f degrees about %c", degrees, name),
           FormatText("turn it with `evit map import --transform` by %.0f degrees about %c", -degrees, name),
           [degrees, axis](World* w) {
             MovePoses(w, [&](const SE3& pose) { return Turn(degrees, axis) * pose; });
           }});
      all->push_back(
          {FormatText("The camera's axes are turned by %.0f degrees about %c in T_body_camera", degrees,
                      name),
           "z must point along the optical axis, x to the right, y down",
           [degrees, axis](World* w) { w->rig.T_body_camera = w->rig.T_body_camera * Turn(degrees, axis); }});
    }
    for (const double degrees : {1.0, -1.0, 2.0, -2.0, 4.0, -4.0, 8.0, -8.0}) {
      all->push_back({FormatText("T_body_camera is off by some %.0f degrees about the camera's %c axis%s",
                                 std::abs(degrees), name, OrCentre(rig, degrees, name).c_str()),
                      "let `evit calibrate` find the extrinsics", [degrees, axis](World* w) {
                        w->rig.T_body_camera = w->rig.T_body_camera * Turn(degrees, axis);
                      }});
    }
  }
}

}  // namespace

std::vector<Assumption> Assumptions(const Rig& rig) {
  std::vector<Assumption> all;
  AddConventions(&all);
  AddImages(&all);
  AddClocks(rig, &all);
  AddTurns(rig, &all);
  return all;
}

}  // namespace evit::diagnosis
