#include "tools/formats/aedat/aedat4_recording.h"

#include <cstring>
#include <stdexcept>
#include <vector>

#include "common/geometry/degrees.h"
#include "common/imu/standard_gravity.h"
#include "tools/formats/aedat/flat_table.h"
#include "tools/formats/import/event_filter.h"

namespace evit::formats {
namespace {

constexpr std::size_t kEventBytes = 16;  // i64 stamp, i16 column, i16 row, bool polarity, padding

class Aedat4Events : public EventSource {
 public:
  Aedat4Events(const std::string& path, int stream, int width, int height)
      : packets_(path), stream_(stream), filter_(width, height) {}

  bool Read(EventArray* events) override {
    events->clear();
    while (events->size() == 0 && packets_.Next(stream_)) {
      try {
        Decode(events);
      } catch (const std::runtime_error& error) {
        packets_.file().Fail(std::string("events: ") + error.what() + "; copy the file again");
      }
      filter_.Apply(events);
    }
    return events->size() > 0;
  }
  double share() const override { return packets_.file().share(); }
  std::string name() const override { return packets_.file().path(); }
  DropCounts dropped() const override {
    DropCounts dropped = filter_.dropped();
    dropped.cut_off = packets_.cut_off();
    return dropped;
  }

 private:
  void Decode(EventArray* events) const {
    std::size_t n = 0;
    const auto& bytes = packets_.contents();
    const std::uint8_t* event =
        FlatTable::Root(bytes.data(), bytes.size(), "EVTS").Structs(0, kEventBytes, &n);
    for (std::size_t k = 0; k < n; ++k, event += kEventBytes) {
      std::int64_t t;
      std::uint16_t pixel[2];  // negative ones become large, which lie outside every sensor
      std::memcpy(&t, event, 8);
      std::memcpy(pixel, event + 8, 4);
      events->push_back(t, pixel[0], pixel[1], event[12] != 0 ? 1 : 0);
    }
  }

  Aedat4Packets packets_;
  int stream_;
  EventFilter filter_;
};

// The stream of a type that is asked for by number or camera, or the only one; -1 where there is none.
int Choose(const Aedat4Packets& packets, const char* type, const std::string& requested, const char* option) {
  std::string names;
  std::vector<int> found;
  for (const auto& [id, stream] : packets.streams()) {
    if (stream.type != type) continue;
    names += (names.empty() ? "" : ", ") + std::to_string(id) + " (" + stream.source + ")";
    if (requested.empty() || requested == std::to_string(id) || requested == stream.source)
      found.push_back(id);
  }
  if (found.size() > 1 || (found.empty() && !requested.empty()))
    packets.file().Fail("choose a stream of type " + std::string(type) + " with " + option + ": " +
                        (names.empty() ? "there is none" : names));
  return found.empty() ? -1 : found.front();
}

// The IMU of a camera, or the only one in a file of one camera, whatever its name.
int ImuOf(const Aedat4Packets& packets, const std::string& camera) {
  std::vector<int> own, all;
  int cameras = 0;
  for (const auto& [id, stream] : packets.streams()) {
    cameras += stream.type == "EVTS" ? 1 : 0;
    if (stream.type != "IMUS") continue;
    all.push_back(id);
    if (stream.source == camera || camera.empty()) own.push_back(id);
  }
  if (!own.empty()) return own.front();
  return all.size() == 1 && cameras == 1 ? all.front() : -1;
}

}  // namespace

Aedat4Recording::Aedat4Recording(const std::string& path, const std::string& events, const std::string& imu,
                                 bool take_events)
    : path_(path) {
  const Aedat4Packets packets(path);
  info_.format = std::string("AEDAT 4.0, ") + packets.compression();
  if (!take_events) {
    imu_ = Choose(packets, "IMUS", imu, "--imu-topic");
    return;
  }
  events_ = Choose(packets, "EVTS", events, "--events-topic");
  if (events_ < 0) packets.file().Fail("holds no stream of events (EVTS)");
  const AedatStream& stream = packets.streams().at(events_);
  info_.sensor = stream.source;
  info_.width = stream.width;
  info_.height = stream.height;
  imu_ = imu.empty() ? ImuOf(packets, stream.source) : Choose(packets, "IMUS", imu, "--imu-topic");
}

std::unique_ptr<EventSource> Aedat4Recording::Events(int width, int height) {
  if (events_ < 0) throw std::runtime_error(path_ + ": was opened for its IMU, not for events");
  return std::make_unique<Aedat4Events>(path_, events_, width, height);
}

ImportStreams Aedat4Recording::Streams() {
  ImportStreams streams;
  if (imu_ < 0) return streams;
  Aedat4Packets packets(path_);
  streams.imu_name = path_ + ": stream " + std::to_string(imu_) + " (IMUS)";
  while (packets.Next(imu_)) {
    try {
      const auto& bytes = packets.contents();
      for (const FlatTable& table : FlatTable::Root(bytes.data(), bytes.size(), "IMUS").Tables(0)) {
        constexpr float kNone = 0;
        const auto vector = [&](int first) {
          return Eigen::Vector3d(table.Get(first, kNone), table.Get(first + 1, kNone),
                                 table.Get(first + 2, kNone));
        };
        const ImuSample s{table.Get<std::int64_t>(0, 0), kRadiansPerDegree * vector(5),
                          kStandardGravity * vector(2)};
        AppendValid(s, s.gyro.allFinite() && s.accel.allFinite(), &streams.imu, &streams.dropped_imu);
      }
    } catch (const std::runtime_error& error) {
      packets.file().Fail(std::string("IMU: ") + error.what() + "; copy the file again");
    }
  }
  if (streams.imu.empty()) streams.imu_name.clear();  // listed, but the camera has none or it was off
  return streams;
}

}  // namespace evit::formats
