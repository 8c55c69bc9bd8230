#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/so3.h"
#include "tests/helpers/doctor_faults.h"

namespace evit::doctor {
namespace {

bool CameraIsApart(const Sample& s) { return s.rig.T_body_camera.p.norm() > 0.01; }

// Whether the image turns by three pixels in so many seconds: a clock that is off by less than that shifts
// the events by no more than the map's own errors.
bool Turns(const Sample& s, double seconds) {
  double sum = 0;
  for (const ImuSample& i : s.imu) sum += i.gyro.squaredNorm();
  return std::sqrt(sum / static_cast<double>(s.imu.size())) * s.rig.camera.fx * seconds > 3;
}

void ScaleFocalLength(Sample* s, double factor) { s->rig.camera.fx *= factor, s->rig.camera.fy *= factor; }

// Without what lies on one side of a plane along the optical axis in the middle of the recording; `side`: in
// the camera's frame.
void CutMap(Sample* s, const Eigen::Vector3d& side) {
  const SE3 T_camera_map = (s->truth[s->truth.size() / 2].pose * s->rig.T_body_camera).Inverse();
  std::vector<Eigen::Vector3f>& points = s->map.points;
  points.erase(
      std::remove_if(points.begin(), points.end(),
                     [&](const Eigen::Vector3f& p) { return side.dot(T_camera_map * p.cast<double>()) > 0; }),
      points.end());
}

}  // namespace

std::vector<Fault> PlaceFaults() {
  return {
      {"IntrinsicsOfTwiceTheResolution", "intrinsics",
       [](Sample* s) {
         Camera& c = s->rig.camera;
         c.fx *= 2, c.fy *= 2, c.cx *= 2, c.cy *= 2, c.cx = std::min(c.cx, c.width - 1.0),
                                                     c.cy = std::min(c.cy, c.height - 1.0);
       },
       [](const Sample& s) {  // else the rig file is refused
         const Camera& c = s.rig.camera;
         return 2 * c.cx < c.width && 2 * c.cy < c.height;
       }},
      {"AccelerometerTurned", "gravity",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel = -i.accel;
       }},
      {"CameraClock40MsOff", "time-offset",
       [](Sample* s) {
         for (Utime& t : s->events.t) t += 40'000;
       },
       [](const Sample& s) { return Turns(s, 0.04); }},
      {"CameraClock60MsOff", "time-offset",
       [](Sample* s) {
         for (Utime& t : s->events.t) t -= 60'000;
       }},
      {"ExtrinsicsInverted", "map-overlap",
       [](Sample* s) { s->rig.T_body_camera = s->rig.T_body_camera.Inverse(); }, CameraIsApart},
      {"ExtrinsicsInMillimetres", "extrinsics", [](Sample* s) { s->rig.T_body_camera.p *= 1000; },
       CameraIsApart},
      {"ExtrinsicsFourDegreesOff", "map-overlap",
       [](Sample* s) {
         s->rig.T_body_camera = s->rig.T_body_camera * SE3(ExpSO3({0, 0.07, 0}), {0, 0, 0});
       }},
      {"ImageUpsideDown", "map-overlap",
       [](Sample* s) {
         for (std::uint16_t& x : s->events.x) x = static_cast<std::uint16_t>(s->rig.camera.width - 1 - x);
         for (std::uint16_t& y : s->events.y) y = static_cast<std::uint16_t>(s->rig.camera.height - 1 - y);
       }},
      {"ImageMirrored", "map-overlap",
       [](Sample* s) {
         for (std::uint16_t& x : s->events.x) x = static_cast<std::uint16_t>(s->rig.camera.width - 1 - x);
       }},
      {"MapInMillimetres", "map-unit",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p *= 1000;
       }},
      {"MapOnItsSide", "map-overlap",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p = Eigen::Vector3f(p.x(), p.z(), -p.y());
       }},
      {"MapOfAnotherPlace", "map-overlap",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p += Eigen::Vector3f(0.7F, 0.4F, 0.3F);
       }},
      {"CameraClockHalfASecondOff", "time-offset",
       [](Sample* s) {
         for (Utime& t : s->events.t) t += 500'000;
       }},
      {"ImageMirroredTopToBottom", "map-overlap",
       [](Sample* s) {
         for (std::uint16_t& y : s->events.y) y = static_cast<std::uint16_t>(s->rig.camera.height - 1 - y);
       }},
      {"ExtrinsicsTurnedAboutTheOpticalAxis", "map-overlap",
       [](Sample* s) {
         s->rig.T_body_camera = s->rig.T_body_camera * SE3(ExpSO3({0, 0, M_PI / 2}), {0, 0, 0});
       }},
      {"MapInCentimetres", "map-unit",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p *= 100;
       }},
      {"TruthOfTheCamera", "truth-frame",
       [](Sample* s) {
         for (StampedPose& p : s->truth) p.pose = p.pose * s->rig.T_body_camera;
       },
       CameraIsApart},
      {"TruthOnAnotherClock", "truth-span",
       [](Sample* s) {
         for (StampedPose& p : s->truth) p.t += 1'000'000'000;
       }},
      {"TruthHalfASecondOff", "truth-time",
       [](Sample* s) {
         for (StampedPose& p : s->truth) p.t -= 400'000;
       }},
      {"CameraClock50MsEarly", "time-offset",
       [](Sample* s) {
         for (Utime& t : s->events.t) t -= 50'000;
       },
       [](const Sample& s) { return Turns(s, 0.05); }},
      {"CameraClock30MsLate", "time-offset",
       [](Sample* s) {
         for (Utime& t : s->events.t) t += 30'000;
       },
       [](const Sample& s) { return Turns(s, 0.03); }},
      {"MapFivePercentTooLarge", "map-scale",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p *= 1.05F;
       }},
      {"MapTenPercentTooSmall", "map-scale",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p *= 0.9F;
       }},
      {"MapAQuarterTooSmall", "map-scale",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p *= 0.75F;
       },
       [](const Sample& s) { return CameraIsApart(s); }},
      {"MapOf150Points", "map-size",
       [](Sample* s) {
         std::vector<Eigen::Vector3f> few;
         for (std::size_t k = 0; k < 150; ++k) few.push_back(s->map.points[k * s->map.points.size() / 150]);
         s->map.points = std::move(few);
       }},
      {"CameraClockFivePercentFast", "clock-drift",
       [](Sample* s) {
         const Utime first = s->events.t.front();
         for (Utime& t : s->events.t) t = first + (t - first) * 21 / 20;
       },
       [](const Sample& s) { return CameraIsApart(s); }},
      {"FocalLengthFivePercentTooLong", "intrinsics-fit", [](Sample* s) { ScaleFocalLength(s, 1.05); }},
      {"FocalLengthTenPercentTooShort", "intrinsics-fit", [](Sample* s) { ScaleFocalLength(s, 0.9); }},
      {"StartPoseOutsideTheMap", "start-view",
       [](Sample* s) {
         s->start = s->truth.front().pose;
         s->start->p += Eigen::Vector3d(40, 30, 0);
       }},
      {"StartPoseFacesNothing", "start-view",
       [](Sample* s) {  // half a turn about the vertical, from behind all points
         s->start = s->truth.front().pose;
         const SE3 T_map_camera = *s->start * s->rig.T_body_camera;
         const Eigen::Vector3d ahead = T_map_camera.q * Eigen::Vector3d::UnitZ();
         s->start->p -= 20 * Eigen::Vector3d(ahead.x(), ahead.y(), 0);
         s->start->q = ExpSO3({0, 0, M_PI}) * s->start->q;
       }},
      {"StartPoseUpsideDown", "start-tilt",
       [](Sample* s) {  // about the optical axis: it sees the same
         const SE3 T_body_camera = s->rig.T_body_camera;
         s->start = s->truth.front().pose * T_body_camera * SE3(ExpSO3({0, 0, M_PI}), {0, 0, 0}) *
                    T_body_camera.Inverse();
       }},
      {"MapTurnedAboutTheVertical", "map-overlap",
       [](Sample* s) {
         for (Eigen::Vector3f& p : s->map.points) p = Eigen::Vector3f(-p.y(), p.x(), p.z());
       }},
      {"LeftHalfOfTheMapMissing", "map-holes",
       [](Sample* s) {
         CutMap(s, {-1, 0, 0});
       }},
      {"UpperHalfOfTheMapMissing", "map-holes",
       [](Sample* s) {
         CutMap(s, {0, -1, 0});
       }},
  };
}

}  // namespace evit::doctor
