#include "tests/helpers/doctor_sample.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"
#include "evit/imu_batch_t.hpp"
#include "tools/doctor/doctor.h"
#include "tools/doctor/recorded_data.h"

namespace evit::doctor {
namespace {

template <typename T>
void WriteMessage(LogWriter* log, Utime utime, const std::string& channel, const T& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  log->Write(utime, channel, bytes.data(), bytes.size());
}

// Events in packets, which are in order each: one ends where stamps go back.
std::vector<event_packet_t> Packets(const EventArray& events) {
  std::vector<event_packet_t> packets;
  EventArray run;
  const auto close = [&] {
    for (event_packet_t& packet : ToPackets(run, 1, static_cast<std::int64_t>(packets.size())))
      packets.push_back(std::move(packet));
    run.clear();
  };
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (run.size() > 0 && events.t[k] < run.t.back()) close();
    run.push_back(events.t[k], events.x[k], events.y[k], events.p[k]);
  }
  close();
  return packets;
}

void WriteLog(const std::string& path, const Sample& s) {
  LogWriter log(path);
  std::int64_t seq = 0;
  std::size_t next = 0;
  const auto write_imu = [&](const ImuSample& sample) {
    imu_batch_t batch = ToMessage(sample);
    batch.seq = seq++, batch.epoch = 1;
    WriteMessage(&log, sample.t, "IMU", batch);
  };
  for (const event_packet_t& packet : Packets(s.events)) {
    for (; next < s.imu.size() && s.imu[next].t <= packet.utime; ++next) write_imu(s.imu[next]);
    WriteMessage(&log, packet.utime, "EVENTS", packet);
  }
  for (; next < s.imu.size(); ++next) write_imu(s.imu[next]);
  log.Close();
}

}  // namespace

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

void AddUniformEvents(Sample* s, std::size_t n, std::mt19937* random) {
  const Utime begin = s->events.t.front(), end = s->events.t.back();
  for (std::size_t k = 0; k < n; ++k)
    s->events.push_back(begin + static_cast<Utime>((*random)() % static_cast<std::uint32_t>(end - begin)),
                        static_cast<std::uint16_t>((*random)() % static_cast<unsigned>(s->rig.camera.width)),
                        static_cast<std::uint16_t>((*random)() % static_cast<unsigned>(s->rig.camera.height)),
                        (*random)() % 2);
  SortEvents(&s->events);
}

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
  if (s.map.points.empty())
    patient.map.clear();
  else
    WritePcd(patient.map, s.map);
  WriteTum(patient.truth, s.truth);
  patient.start = s.start;
  diagnosis::Findings findings = Examine(patient, [](double) {});
  std::filesystem::remove_all(folder);
  return findings;
}

}  // namespace evit::doctor
