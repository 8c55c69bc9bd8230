#include "tests/helpers/doctor_faults.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "common/geometry/so3.h"

namespace evit::doctor {
namespace {

using diagnosis::Finding;
using diagnosis::Severity;

bool CameraIsApart(const Sample& s) { return s.rig.T_body_camera.p.norm() > 0.01; }

// Whether the image turns by three pixels in so many seconds: a clock that is off by less than that shifts
// the events by no more than the map's own errors.
bool Turns(const Sample& s, double seconds) {
  double sum = 0;
  for (const ImuSample& i : s.imu) sum += i.gyro.squaredNorm();
  return std::sqrt(sum / static_cast<double>(s.imu.size())) * s.rig.camera.fx * seconds > 3;
}

// Whether pixels fire so often that one without any event is not chance.
bool FiresEverywhere(const Sample& s) {
  return s.events.size() > 5 * static_cast<std::size_t>(s.rig.camera.width * s.rig.camera.height);
}

// Without the events of a rectangle, given as shares of the image.
void SilencePixels(Sample* s, double left, double top, double right, double bottom) {
  const int w = s->rig.camera.width, h = s->rig.camera.height;
  KeepEvents(s, [&](std::size_t k) {
    const int x = s->events.x[k], y = s->events.y[k];
    return x < left * w || x >= right * w || y < top * h || y >= bottom * h;
  });
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

const std::vector<Fault>& Faults() {
  static const std::vector<Fault> faults{
      {"PolarityLost", "polarity", [](Sample* s) { std::fill(s->events.p.begin(), s->events.p.end(), 1); }},
      {"PixelsOfAnotherCamera", "sensor-size",
       [](Sample* s) {
         Camera& c = s->rig.camera;
         c.width = c.width * 3 / 4, c.height = c.height * 3 / 4, c.cx *= 0.75, c.cy *= 0.75;
       }},
      {"RigOfTwiceTheResolution", "sensor-size",
       [](Sample* s) {
         Camera& c = s->rig.camera;
         c.width *= 2, c.height *= 2, c.fx *= 2, c.fy *= 2, c.cx *= 2, c.cy *= 2;
       }},
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
      {"EventsLostForThreeTenthsOfASecond", "event-gaps",
       [](Sample* s) {
         KeepEvents(s, [s](std::size_t k) {
           return std::abs(s->events.t[k] - s->imu.front().t - 1'500'000) > 150'000;
         });
       }},
      {"ATenthOfThePixelsDead", "dead-pixels",
       [](Sample* s) {
         KeepEvents(
             s, [s](std::size_t k) { return (s->events.x[k] * 7919 + s->events.y[k] * 104729) % 10 != 0; });
       },
       FiresEverywhere},
      {"HotPixels", "hot-pixels",
       [](Sample* s) {
         std::mt19937 random(1);
         const auto width = static_cast<unsigned>(s->rig.camera.width),
                    height = static_cast<unsigned>(s->rig.camera.height);
         const Utime begin = s->events.t.front(), end = s->events.t.back();
         for (int n = 0; n < 60; ++n) {
           const auto x = static_cast<std::uint16_t>(random() % width),
                      y = static_cast<std::uint16_t>(random() % height);
           for (Utime t = begin; t < end; t += 500) s->events.push_back(t, x, y, t / 500 % 2);
         }
         SortEvents(&s->events);
       }},
      {"Noise", "event-noise",
       [](Sample* s) {
         std::mt19937 random(2);
         const auto width = static_cast<unsigned>(s->rig.camera.width),
                    height = static_cast<unsigned>(s->rig.camera.height);
         KeepEvents(s, [](std::size_t k) { return k % 20 == 0; });
         const Utime begin = s->events.t.front(), end = s->events.t.back();
         for (int n = 0; n < 300'000; ++n)
           s->events.push_back(begin + static_cast<Utime>(random() % static_cast<std::uint32_t>(end - begin)),
                               static_cast<std::uint16_t>(random() % width),
                               static_cast<std::uint16_t>(random() % height), random() % 2);
         SortEvents(&s->events);
       }},
      {"LampOnMains", "flicker",
       [](Sample* s) {
         const EventArray before = s->events;
         for (std::size_t k = 0; k < before.size(); k += 2) {
           const double phase = 2 * M_PI * 100 * ToSeconds(before.t[k]);
           s->events.push_back(before.t[k], before.x[k], before.y[k], std::sin(phase) > 0 ? 1 : 0);
         }
         SortEvents(&s->events);
       }},
      {"LensCovered", "event-rate",
       [](Sample* s) { KeepEvents(s, [](std::size_t k) { return k % 1000 == 0; }); }},
      {"AccelerometerInG", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel /= 9.81;
       }},
      {"AccelerometerInMillimetres", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 1000;
       }},
      {"GravityRemoved", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) {
           SE3 pose;
           if (PoseAt(s->truth, i.t, &pose)) i.accel -= pose.q.conjugate() * Eigen::Vector3d(0, 0, 9.81);
         }
       }},
      {"AccelerometerTurned", "gravity",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel = -i.accel;
       }},
      {"GyroInDegrees", "imu-gyro-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro *= 57.29578;
       }},
      {"GyroTurned", "imu-gyro-axes",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro = -i.gyro;
       }},
      {"GyroCutOff", "imu-saturation",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro = (5 * i.gyro).cwiseMax(-1.2).cwiseMin(1.2) / 1;
       }},
      {"ImuSamplesMissing", "imu-gaps",
       [](Sample* s) {
         std::vector<ImuSample> kept;
         for (const ImuSample& i : s->imu)
           if (std::abs(i.t - s->imu.front().t - 1'500'000) > 150'000) kept.push_back(i);
         s->imu = kept;
       }},
      {"ImuTooSlow", "imu-rate",
       [](Sample* s) {
         std::vector<ImuSample> kept;
         for (std::size_t k = 0; k < s->imu.size(); k += 8) kept.push_back(s->imu[k]);
         s->imu = kept;
       }},
      {"ImuOnAnotherClock", "clocks",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.t += 3'000'000'000;
         for (StampedPose& p : s->truth) p.t += 3'000'000'000;
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
      {"GyroZero", "imu-gyro-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.gyro.setZero();
       }},
      {"ImuStampsRepeat", "imu-order",
       [](Sample* s) {
         for (std::size_t k = 3; k < s->imu.size(); k += 3) s->imu[k].t = s->imu[k - 1].t;
       }},
      {"ImuVibrates", "imu-noise",
       [](Sample* s) {
         std::mt19937 random(3);
         std::normal_distribution<double> noise(0, 0.4);
         for (ImuSample& i : s->imu)
           for (int axis = 0; axis < 3; ++axis)
             i.gyro[axis] += noise(random), i.accel[axis] += 2 * noise(random);
       }},
      {"AccelerometerInCentimetres", "imu-accel-unit",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 100;
       }},
      {"PixelsSubsampled", "dead-pixels",
       [](Sample* s) {
         KeepEvents(s, [s](std::size_t k) { return s->events.x[k] % 2 == 0 && s->events.y[k] % 2 == 0; });
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
      {"StripeOfColumnsDead", "dead-area", [](Sample* s) { SilencePixels(s, 0.55, 0, 0.63, 1); }},
      {"StripeOfRowsDead", "dead-area", [](Sample* s) { SilencePixels(s, 0, 0.3, 1, 0.35); }},
      {"ColumnsAtTheEdgeDead", "dead-area", [](Sample* s) { SilencePixels(s, 0, 0, 0.1, 1); },
       FiresEverywhere},
      {"BlockOfPixelsDead", "dead-area", [](Sample* s) { SilencePixels(s, 0.4, 0.35, 0.65, 0.6); }},
      {"AccelerometerReadsTenPercentMore", "imu-accel-scale",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 1.1;
       }},
      {"AccelerometerReadsFifteenPercentLess", "imu-accel-scale",
       [](Sample* s) {
         for (ImuSample& i : s->imu) i.accel *= 0.85;
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
      {"MostEventsOfOnePolarity", "polarity",
       [](Sample* s) {
         for (std::size_t k = 0; k < s->events.size(); ++k) s->events.p[k] = k % 10 == 0 ? 0 : 1;
       }},
      {"LampOn60HertzMains", "flicker",
       [](Sample* s) {
         const EventArray before = s->events;
         for (std::size_t k = 0; k < before.size(); ++k) {
           const double phase = 2 * M_PI * 120 * ToSeconds(before.t[k]);
           s->events.push_back(before.t[k], before.x[k], before.y[k], std::sin(phase) > 0 ? 1 : 0);
         }
         SortEvents(&s->events);
       }},
      {"EventsLostAgainAndAgain", "event-gaps",
       [](Sample* s) {
         const Utime first = s->imu.front().t;
         KeepEvents(s, [s, first](std::size_t k) { return (s->events.t[k] - first) % 500'000 > 120'000; });
       }},
      {"GyroRangeTooSmall", "imu-saturation",
       [](Sample* s) {
         for (ImuSample& i : s->imu)
           for (int axis = 0; axis < 3; ++axis) i.gyro[axis] = std::clamp(6 * i.gyro[axis], -1.5, 1.5);
       }},
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
      {"NoiseFromEverywhere", "event-noise",
       [](Sample* s) {
         std::mt19937 random(4);
         KeepEvents(s, [](std::size_t k) { return k % 30 == 0; });
         const Utime begin = s->events.t.front(), end = s->events.t.back();
         for (int n = 0; n < 200'000; ++n)
           s->events.push_back(
               begin + static_cast<Utime>(random() % static_cast<std::uint32_t>(end - begin)),
               static_cast<std::uint16_t>(random() % static_cast<unsigned>(s->rig.camera.width)),
               static_cast<std::uint16_t>(random() % static_cast<unsigned>(s->rig.camera.height)), 1);
         for (std::size_t k = 0; k < s->events.size(); k += 2) s->events.p[k] = 0;
         SortEvents(&s->events);
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
  return faults;
}

bool IsNamed(const std::vector<std::string>& checks, const diagnosis::Findings& findings, std::string* said) {
  bool named = false;
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const Finding& f = findings[k];
    if (f.severity == Severity::kGood) continue;
    *said += f.check + ": " + f.what + " (" + f.figure + ")\n";
    named = named || (k < 2 && std::find(checks.begin(), checks.end(), f.check) != checks.end());
  }
  return named;
}

bool IsNamed(const Fault& fault, const diagnosis::Findings& findings, std::string* said) {
  return IsNamed(std::vector<std::string>{fault.check}, findings, said);
}

}  // namespace evit::doctor
