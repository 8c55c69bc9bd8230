// Faults of the rig file, of known poses and of the start.
#include <algorithm>
#include <cmath>

#include "common/geometry/so3.h"
#include "common/text/format_text.h"
#include "tests/helpers/random_faults.h"

namespace evit::doctor {
namespace {

SE3 TurnBy(double degrees, const Eigen::Vector3d& axis) {
  return {ExpSO3(degrees * M_PI / 180 * axis), Eigen::Vector3d::Zero()};
}

std::string OtherResolution(Sample* s, Chance* chance) {
  Camera& c = s->rig.camera;
  const double scale = Either(chance, 0.5, 2);
  const bool size = Pick(chance, 2) == 0;
  const double w = c.width, h = c.height;
  c.fx *= scale, c.fy *= scale, c.cx = (c.cx + 0.5) * scale - 0.5, c.cy = (c.cy + 0.5) * scale - 0.5;
  if (size)
    c.width = static_cast<int>(w * scale), c.height = static_cast<int>(h * scale);
  else if (c.cx > w - 1 || c.cy > h - 1)  // else the rig file is refused
    return "";
  return FormatText("intrinsics%s of %.1f times the resolution", size ? " and size" : "", scale);
}

std::string OtherFocalLength(Sample* s, Chance* chance) {
  const double off = Either(chance, -1, 1) * Draw(chance, 0.05, 0.2);
  s->rig.camera.fx *= 1 + off, s->rig.camera.fy *= 1 + off;
  return FormatText("focal length %+.0f %%", 100 * off);
}

std::string OtherCentre(Sample* s, Chance* chance) {
  Camera& c = s->rig.camera;
  const double dx = Either(chance, -1, 1) * Draw(chance, 0.04, 0.1) * c.width,
               dy = Either(chance, -1, 1) * Draw(chance, 0.04, 0.1) * c.height;
  c.cx += dx, c.cy += dy;
  return FormatText("principal point off by %.0f, %.0f pixels", dx, dy);
}

std::string InvertExtrinsics(Sample* s, Chance* chance) {
  SE3& T = s->rig.T_body_camera;
  const SE3 inverse = T.Inverse();
  const int what = Pick(chance, 3);
  if (what == 0) T = inverse;
  if (what == 1) T.q = inverse.q;
  if (what == 2) T = SE3();
  const SE3 off = T * inverse;
  if (off.q.angularDistance(Eigen::Quaterniond::Identity()) < 0.1 && off.p.norm() < 0.05) return "";
  return what == 0 ? "T_body_camera inverted" : what == 1 ? "its rotation inverted" : "no T_body_camera";
}

std::string TurnExtrinsics(Sample* s, Chance* chance) {
  const bool right_angle = Pick(chance, 2) == 0;
  const double degrees = right_angle ? Either(chance, 90, 180) : Draw(chance, 3, 12);
  const Eigen::Vector3d axis =
      right_angle ? Eigen::Vector3d(Eigen::Matrix3d::Identity().col(Pick(chance, 3))) : DrawDirection(chance);
  s->rig.T_body_camera = s->rig.T_body_camera * TurnBy(degrees, axis);
  return FormatText("T_body_camera turned by %.0f deg", degrees);
}

std::string MoveExtrinsics(Sample* s, Chance* chance) {
  const bool unit = s->rig.T_body_camera.p.norm() > 0.01 && Pick(chance, 2) == 0;
  const double factor = Either(chance, 100, 1000);
  if (unit) s->rig.T_body_camera.p *= factor;
  const Eigen::Vector3d by = Draw(chance, 0.15, 0.5) * DrawDirection(chance);
  if (!unit) s->rig.T_body_camera.p += by;
  return unit ? FormatText("T_body_camera %g times too far", factor)
              : FormatText("T_body_camera moved by %.0f cm", 100 * by.norm());
}

std::string FlipImage(Sample* s, Chance* chance) {
  const int what = 1 + Pick(chance, 3);
  const int w = s->rig.camera.width, h = s->rig.camera.height;
  if ((what & 1) != 0)
    for (std::uint16_t& x : s->events.x) x = static_cast<std::uint16_t>(w - 1 - x);
  if ((what & 2) != 0)
    for (std::uint16_t& y : s->events.y) y = static_cast<std::uint16_t>(h - 1 - y);
  return what == 1 ? "image mirrored" : what == 2 ? "image mirrored top to bottom" : "image upside down";
}

std::string SpoilTruth(Sample* s, Chance* chance) {
  const int what = Pick(chance, 4);
  const Utime by = std::llround(Either(chance, -1, 1) * Draw(chance, 1e5, 5e5));
  if (what == 0 && s->rig.T_body_camera.q.angularDistance(Eigen::Quaterniond::Identity()) < 0.2) return "";
  for (StampedPose& p : s->truth) {
    if (what == 0) p.pose = p.pose * s->rig.T_body_camera;
    if (what == 1) p.pose = p.pose.Inverse();
    if (what == 2) p.t += by;
    if (what == 3) p.pose.q = Eigen::Quaterniond(p.pose.q.z(), p.pose.q.w(), p.pose.q.x(), p.pose.q.y());
  }
  return what == 0   ? "truth of the camera"
         : what == 1 ? "truth inverted"
         : what == 2 ? FormatText("truth %+.0f ms late", 1e3 * ToSeconds(by))
                     : "truth with quaternions w first";
}

std::string StartElsewhere(Sample* s, Chance* chance) {
  const SE3 start = s->truth.front().pose;
  const int what = Pick(chance, 4);
  const double degrees = Draw(chance, 60, 180), metres = Draw(chance, 10, 100), near = Draw(chance, 0.8, 3);
  const Eigen::Vector3d aside =
      Eigen::Vector3d(DrawDirection(chance).x(), DrawDirection(chance).y(), 0).normalized();
  s->start = start;
  if (what == 0) s->start->p += metres * aside;
  if (what == 1) s->start->q = ExpSO3({0, 0, degrees * M_PI / 180}) * start.q;
  if (what == 2) s->start->q = start.q * ExpSO3(degrees * M_PI / 180 * DrawDirection(chance));
  if (what == 3) s->start->p += near * aside;
  return what == 0   ? FormatText("start %.0f m away", metres)
         : what == 1 ? FormatText("start looks %.0f deg to the side", degrees)
         : what == 2 ? FormatText("start turned by %.0f deg about any axis", degrees)
                     : FormatText("start %.1f m to the side", near);
}

}  // namespace

std::vector<RandomFault> RandomRigFaults() {
  const std::vector<std::string> placed{"map-overlap", "extrinsics"};
  return {{"intrinsics of another resolution",
           {"sensor-size", "intrinsics", "intrinsics-fit", "map-overlap"},
           OtherResolution},
          {"focal length", {"intrinsics-fit", "intrinsics"}, OtherFocalLength},
          {"principal point",  // which a small turn of the camera resembles: both are named
           {"intrinsics-fit", "intrinsics", "map-overlap"},
           OtherCentre},
          {"extrinsics inverted", placed, InvertExtrinsics},
          {"extrinsics turned", placed, TurnExtrinsics},
          {"extrinsics moved", placed, MoveExtrinsics},
          {"image mirrored", {"map-overlap"}, FlipImage},
          {"truth", {"truth-frame", "truth-time", "truth-rotation", "truth-span"}, SpoilTruth},
          {"start pose", {"start-view", "start-tilt", "start-pose"}, StartElsewhere}};
}

}  // namespace evit::doctor
