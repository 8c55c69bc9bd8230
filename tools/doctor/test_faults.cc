#include "tools/doctor/test_faults.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"
#include "evit/imu_batch_t.hpp"
#include "tools/doctor/recorded_data.h"

namespace evit::doctor {
namespace {

using diagnosis::Finding;
using diagnosis::Severity;

template <typename T>
void WriteMessage(LogWriter* log, Utime utime, const std::string& channel, const T& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  log->Write(utime, channel, bytes.data(), bytes.size());
}

void WriteLog(const std::string& path, const Sample& s) {
  LogWriter log(path);
  std::int64_t seq = 0;
  std::size_t next = 0;
  for (const event_packet_t& packet : ToPackets(s.events, 1, 0)) {
    for (; next < s.imu.size() && s.imu[next].t <= packet.utime; ++next) {
      imu_batch_t batch = ToMessage(s.imu[next]);
      batch.seq = seq++, batch.epoch = 1;
      WriteMessage(&log, s.imu[next].t, "IMU", batch);
    }
    WriteMessage(&log, packet.utime, "EVENTS", packet);
  }
  for (; next < s.imu.size(); ++next) {
    imu_batch_t batch = ToMessage(s.imu[next]);
    batch.seq = seq++, batch.epoch = 1;
    WriteMessage(&log, s.imu[next].t, "IMU", batch);
  }
  log.Close();
}

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

void KeepEvents(Sample* s, const std::function<bool(std::size_t)>& keep) {
  EventArray kept;
  for (std::size_t k = 0; k < s->events.size(); ++k)
    if (keep(k)) kept.push_back(s->events.t[k], s->events.x[k], s->events.y[k], s->events.p[k]);
  s->events = std::move(kept);
}

void SortEvents(EventArray* events) {
  std::vector<std::size_t> order(events->size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [events](std::size_t a, std::size_t b) { return events->t[a] < events->t[b]; });
  EventArray sorted;
  for (const std::size_t k : order) sorted.push_back(events->t[k], events->x[k], events->y[k], events->p[k]);
  *events = std::move(sorted);
}

}  // namespace

Sample LoadSample(const std::string& log, const std::string& rig, const std::string& map,
                  const std::string& truth, double seconds) {
  Sample s;
  RecordedData data(log);
  data.Read(seconds, {[&s](const EventArray& part) {
                        for (std::size_t k = 0; k < part.size(); ++k)
                          s.events.push_back(part.t[k], part.x[k], part.y[k], part.p[k]);
                      },
                      [&s](const std::vector<ImuSample>& part) {
                        s.imu.insert(s.imu.end(), part.begin(), part.end());
                      },
                      [](double) {}});
  s.truth = ReadTum(truth);
  s.map = LoadMap(map).map;
  s.rig = LoadRig(rig);
  return s;
}

Sample Piece(const Sample& sample, double begin, double end) {
  const Utime first = sample.events.t.front(), from = first + std::llround(1e6 * begin),
              to = first + std::llround(1e6 * end);
  const auto outside = [&](const auto& s) { return s.t < from || s.t > to; };
  Sample piece = sample;
  KeepEvents(&piece, [&](std::size_t k) { return sample.events.t[k] >= from && sample.events.t[k] <= to; });
  piece.imu.erase(std::remove_if(piece.imu.begin(), piece.imu.end(), outside), piece.imu.end());
  piece.truth.erase(std::remove_if(piece.truth.begin(), piece.truth.end(), outside), piece.truth.end());
  return piece;
}

Sample Thinned(const Sample& sample, int n) {
  Sample thinned = sample;
  KeepEvents(&thinned, [n](std::size_t k) { return k % static_cast<std::size_t>(n) != 0; });
  return thinned;
}

diagnosis::Findings ExamineSample(const Sample& s) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("evit_doctor_test_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  Patient patient;
  patient.log = folder / "log.lcmlog", patient.rig = folder / "rig.textproto",
  patient.map = folder / "map.pcd", patient.truth = folder / "truth.tum";
  WriteLog(patient.log, s);
  WriteRig(patient.rig, s.rig, "sick", "");
  WritePcd(patient.map, s.map);
  WriteTum(patient.truth, s.truth);
  const diagnosis::Findings findings = Examine(patient, [](double) {});
  std::filesystem::remove_all(folder);
  return findings;
}

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
      {"CameraClock40MsOff", "map-overlap",
       [](Sample* s) {
         for (Utime& t : s->events.t) t += 40'000;
       },
       [](const Sample& s) { return Turns(s, 0.04); }},
      {"CameraClock60MsOff", "map-overlap",
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
  };
  return faults;
}

bool IsNamed(const Fault& fault, const diagnosis::Findings& findings, std::string* said) {
  bool named = false;
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const Finding& f = findings[k];
    if (f.severity == Severity::kGood) continue;
    *said += f.check + ": " + f.what + " (" + f.figure + ")\n";
    named = named || (k < 2 && f.check == fault.check);
  }
  return named;
}

}  // namespace evit::doctor
