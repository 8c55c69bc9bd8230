#include "tools/formats/prophesee/raw_recording.h"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "tools/formats/import/byte_file.h"
#include "tools/formats/import/event_filter.h"
#include "tools/formats/prophesee/dat_decoder.h"
#include "tools/formats/prophesee/evt2_decoder.h"
#include "tools/formats/prophesee/evt3_decoder.h"
#include "tools/formats/prophesee/raw_header.h"

namespace evit::formats {
namespace {

constexpr std::size_t kBlock = 1 << 18;    // bytes decoded at a time: what comes of them stays in the cache
constexpr std::size_t kLongest = 1 << 24;  // bytes without a TIME_HIGH: no sensor is silent for so long

class RawEvents : public EventSource {
 public:
  RawEvents(const std::string& path, std::uint64_t begin, std::unique_ptr<EventDecoder> decoder, int width,
            int height)
      : file_(path), decoder_(std::move(decoder)), filter_(width, height) {
    file_.Seek(begin);
  }

  bool Read(EventArray* events) override {
    events->clear();
    while (events->size() == 0) {
      const bool more = file_.Fill(kBlock);
      if (file_.available() == 0) break;
      const bool last = !more || file_.available() > kLongest;
      file_.Use(decoder_->Decode(file_.data(), file_.available(), last, events));
      filter_.Apply(events);
      cut_off_ = !more && file_.available() > 0;
      if (!more) break;
    }
    return events->size() > 0;
  }
  double share() const override { return file_.share(); }
  std::string name() const override { return file_.path(); }
  DropCounts dropped() const override {
    DropCounts dropped = filter_.dropped();
    dropped.unstamped = decoder_->unstamped();
    dropped.cut_off = cut_off_;
    return dropped;
  }

 private:
  ByteFile file_;
  std::unique_ptr<EventDecoder> decoder_;
  EventFilter filter_;
  bool cut_off_ = false;
};

}  // namespace

bool RawRecording::Recognises(const std::string& path) {
  ByteFile file(path);
  if (!file.Fill(2) || file.available() < 2 || file.data()[0] != '%' || file.data()[1] != ' ') return false;
  try {
    // Text may have such comments above its rows.
    const RawHeader header(&file);
    if (!header.Get("format").empty() || !header.Get("evt").empty()) return true;
    file.Fill(1);
    return file.available() == 0 || std::strchr("0123456789-+ ", *file.data()) == nullptr ||
           *file.data() == 0;
  } catch (const std::runtime_error&) {
    return true;  // opening it says what is wrong
  }
}

RawRecording::RawRecording(const std::string& path) : path_(path) {
  ByteFile file(path);
  const RawHeader header(&file);
  SensorSize(header, &info_.width, &info_.height);
  for (const char* key : {"sensor_name", "plugin_name", "camera_integrator_name", "integrator_name"}) {
    if (info_.sensor.empty()) info_.sensor = header.Get(key);
  }
  std::string name = header.Get("format");
  if (name.empty()) name = header.Get("evt");
  if (name == "EVT2" || name == "2.0") {
    encoding_ = Encoding::kEvt2;
    info_.format = "Metavision RAW, EVT 2.0";
  } else if (name == "EVT3" || name == "3.0") {
    encoding_ = Encoding::kEvt3;
    info_.format = "Metavision RAW, EVT 3.0";
  } else if (name == "EVT21" || name == "EVT2.1" || name == "2.1") {
    file.Fill(1 << 20);
    // The header of some versions says the order of bytes only, not that of the halves: the words themselves
    // know better.
    const bool upper_first =
        Evt21Decoder::UpperHalfFirst(file.data(), file.available(), header.Get("endianness") == "legacy");
    encoding_ = upper_first ? Encoding::kEvt21UpperFirst : Encoding::kEvt21;
    info_.format =
        std::string("Metavision RAW, EVT 2.1 (") + (upper_first ? "upper half first)" : "little-endian)");
  } else if (!name.empty()) {
    file.Fail("its encoding is " + name +
              "; known are EVT2, EVT21 and EVT3: convert it with metavision_file_to_dat");
  } else {
    const std::uint8_t* type = file.Take(2, "event type and size");
    if ((type[0] != 0x00 && type[0] != 0x0C) || type[1] != 8) {
      file.Fail(
          "its header names no encoding (% evt, % format), and it is not a DAT file of CD events (type " +
          std::to_string(type[0]) + ", " + std::to_string(type[1]) + " bytes)");
    }
    encoding_ = Encoding::kDat;
    info_.format = "Metavision DAT";
  }
  if (header.Get("endianness") == "big")
    file.Fail("is big-endian, which is not read; record it little-endian");
  begin_ = file.position();
}

std::unique_ptr<EventSource> RawRecording::Events(int width, int height) {
  std::unique_ptr<EventDecoder> decoder;
  switch (encoding_) {
    case Encoding::kEvt2:
      decoder = std::make_unique<Evt2Decoder>();
      break;
    case Encoding::kEvt21:
    case Encoding::kEvt21UpperFirst:
      decoder = std::make_unique<Evt21Decoder>(encoding_ == Encoding::kEvt21UpperFirst);
      break;
    case Encoding::kEvt3:
      decoder = std::make_unique<Evt3Decoder>();
      break;
    case Encoding::kDat:
      decoder = std::make_unique<DatDecoder>();
      break;
  }
  return std::make_unique<RawEvents>(path_, begin_, std::move(decoder), width, height);
}

}  // namespace evit::formats
