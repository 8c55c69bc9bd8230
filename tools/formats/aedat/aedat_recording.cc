#include "tools/formats/aedat/aedat_recording.h"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "tools/formats/aedat/aedat2_decoder.h"
#include "tools/formats/aedat/aedat3_decoder.h"
#include "tools/formats/import/byte_file.h"
#include "tools/formats/import/event_filter.h"

namespace evit::formats {
namespace {

constexpr char kMagic[] = "#!AER-DAT";
constexpr std::size_t kBlock = 1 << 18,
                      kMaxLine = 1 << 20;  // bytes; jAER writes its preferences into the header

// Goes through the file once; events and samples come together.
class Pass {
 public:
  Pass(const std::string& path, std::uint64_t begin, std::unique_ptr<AedatDecoder> decoder)
      : file_(path), decoder_(std::move(decoder)) {
    file_.Seek(begin);
  }
  /// False at the end. A packet that is cut off there is left out.
  bool Next(EventArray* events, std::vector<ImuSample>* imu) {
    if (!file_.Fill(kBlock)) return false;
    try {
      file_.Use(decoder_->Decode(file_.data(), file_.available(), events, imu));
    } catch (const std::runtime_error& error) {
      file_.Fail("at byte " + std::to_string(file_.position()) + ": " + error.what());
    }
    return true;
  }
  const ByteFile& file() const { return file_; }

 private:
  ByteFile file_;
  std::unique_ptr<AedatDecoder> decoder_;
};

class AedatEvents : public EventSource {
 public:
  AedatEvents(Pass pass, int width, int height) : pass_(std::move(pass)), filter_(width, height) {}

  bool Read(EventArray* events) override {
    events->clear();
    while (events->size() == 0) {
      imu_.clear();
      if (!pass_.Next(events, &imu_)) {
        cut_off_ = pass_.file().available() > 0;
        return false;
      }
      filter_.Apply(events);
    }
    return true;
  }
  double share() const override { return pass_.file().share(); }
  std::string name() const override { return pass_.file().path(); }
  DropCounts dropped() const override {
    DropCounts dropped = filter_.dropped();
    dropped.cut_off = cut_off_;
    return dropped;
  }

 private:
  Pass pass_;
  EventFilter filter_;
  std::vector<ImuSample> imu_;  // not asked for
  bool cut_off_ = false;
};

// The chip by what the header says of it.
void FindSensor(const std::string& header, RecordingInfo* info) {
  const struct {
    const char* name;
    int width, height;
  } chips[] = {{"DVS128", 128, 128},   {"DAVIS128", 128, 128},  {"DAVIS208", 208, 192},
               {"DAVIS240", 240, 180}, {"DAVIS346", 346, 260},  {"DAVIS640", 640, 480},
               {"Davis208", 208, 192}, {"Davis240", 240, 180},  {"Davis346", 346, 260},
               {"Davis640", 640, 480}, {"DVXPLORER", 640, 480}, {"DVXplorer", 640, 480}};
  for (const auto& chip : chips) {
    if (header.find(chip.name) == std::string::npos) continue;
    info->sensor = chip.name;
    info->width = chip.width;
    info->height = chip.height;
    return;
  }
}

}  // namespace

bool AedatRecording::Recognises(const std::string& path) {
  ByteFile file(path);
  constexpr std::size_t n = sizeof kMagic - 1;
  return file.Fill(n) && file.available() >= n && std::memcmp(file.data(), kMagic, n) == 0;
}

AedatRecording::AedatRecording(const std::string& path) : path_(path) {
  ByteFile file(path);
  std::string chip, version;
  while (true) {
    if (file.available() < kMaxLine) file.Fill(kMaxLine);
    if (file.available() == 0 || *file.data() != '#') break;
    const auto* begin = reinterpret_cast<const char*>(file.data());
    const auto* end = static_cast<const char*>(std::memchr(begin, '\n', file.available()));
    if (end == nullptr) break;  // data that begins with 35
    const std::string line(begin, end);
    file.Use(line.size() + 1);
    if (version.empty() && line.rfind(kMagic, 0) == 0) version = line.substr(sizeof kMagic - 1, 3);
    if (line.rfind("#Source", 0) == 0 || line.find("AEChip") != std::string::npos ||
        line.find("HardwareInterface") != std::string::npos) {
      chip += line + "\n";
    }
    if (line.rfind("#!END-HEADER", 0) == 0) break;
  }
  begin_ = file.position();
  version_3_ = version == "3.1" || version == "3.0";
  if (!version_3_ && version != "2.0")
    file.Fail("is AEDAT " + version + "; 2.0, 3.1 and 4.0 can be read: convert it with DV");
  info_.format = "AEDAT " + version;
  FindSensor(chip, &info_);
  // Without the chip, the addresses of AEDAT 2.0 say nothing.
  if (!version_3_ && info_.width == 0)
    file.Fail("its header names no chip that is known (AEChip); re-export it as AEDAT 3.1 or 4.0");
}

std::unique_ptr<AedatDecoder> AedatRecording::Decoder() const {
  if (version_3_) return std::make_unique<Aedat3Decoder>();
  return std::make_unique<Aedat2Decoder>(info_.width, info_.height);
}

std::unique_ptr<EventSource> AedatRecording::Events(int width, int height) {
  return std::make_unique<AedatEvents>(Pass(path_, begin_, Decoder()), width, height);
}

ImportStreams AedatRecording::Streams() {
  ImportStreams streams;
  streams.imu_name = path_ + ": IMU";
  Pass pass(path_, begin_, Decoder());
  EventArray events;
  std::vector<ImuSample> imu;
  while (pass.Next(&events, &imu)) {
    for (const ImuSample& s : imu)
      AppendValid(s, s.gyro.allFinite() && s.accel.allFinite(), &streams.imu, &streams.dropped_imu);
    events.clear();
    imu.clear();
  }
  if (streams.imu.empty()) streams.imu_name.clear();
  return streams;
}

}  // namespace evit::formats
