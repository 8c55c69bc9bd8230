#include "tools/formats/numpy/npy_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/formats/import/event_filter.h"

namespace evit::formats {
namespace {

constexpr std::uint64_t kPiece = 100'000;  // events
constexpr std::uint64_t kTelling = 1000;   // rows
constexpr double kLongest = 9e18;          // us

std::string Word(const NpyHeader::Field& field, const std::uint8_t* row) {
  if (field.kind != 'f') return std::to_string(NpyInteger(field, row));
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", NpyNumber(field, row));
  return text;
}

// us in a unit.
double Micros(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::kSeconds:
      return 1e6;
    case TimeUnit::kMilliseconds:
      return 1e3;
    case TimeUnit::kMicroseconds:
      return 1;
    default:
      return 1e-3;
  }
}

class NpyEvents : public EventSource {
 public:
  NpyEvents(const std::string& path, const EventColumns& columns, int width, int height)
      : file_(path),
        header_(ReadNpyHeader(&file_)),
        left_(header_.rows),
        micros_(Micros(columns.unit)),
        filter_(width, height) {
    for (std::size_t k = 0; k < columns.n; ++k) {
      if (columns.field[k] != EventColumns::kIgnored) fields_[columns.field[k]] = header_.fields[k];
    }
  }

  bool Read(EventArray* events) override {
    events->clear();
    while (left_ > 0 && events->size() == 0) {
      const std::uint64_t n = std::min(left_, kPiece);
      const std::uint8_t* row = file_.Take(n * header_.row_bytes, "the events");
      left_ -= n;
      for (const std::uint8_t* end = row + n * header_.row_bytes; row < end; row += header_.row_bytes)
        Add(row, events);
    }
    return events->size() > 0;
  }
  double share() const override { return file_.share(); }
  std::string name() const override { return file_.path(); }
  DropCounts dropped() const override { return filter_.dropped(); }

 private:
  std::int64_t Whole(EventColumns::Field which, const char* what, const std::uint8_t* row) const {
    const NpyHeader::Field& field = fields_[which];
    if (field.kind != 'f') return NpyInteger(field, row);
    const double value = NpyNumber(field, row);
    if (!(std::abs(value) < 1e15) || value != std::floor(value))
      file_.Fail(std::string(what) + " is " + std::to_string(value) + ", which is no whole number");
    return static_cast<std::int64_t>(value);
  }
  void Add(const std::uint8_t* row, EventArray* events) {
    const NpyHeader::Field& time = fields_[EventColumns::kTime];
    Utime t = 0;
    if (time.kind != 'f' && micros_ == 1) {
      t = NpyInteger(time, row);
    } else {
      // Whole numbers of other units are dates in ns at most, which a long double holds.
      const long double value = time.kind != 'f' ? static_cast<long double>(NpyInteger(time, row)) * micros_
                                                 : static_cast<long double>(NpyNumber(time, row)) * micros_;
      if (!(std::abs(value) < kLongest)) return filter_.CountInvalid();
      t = std::llround(value);
    }
    const std::int64_t x = Whole(EventColumns::kX, "a column", row),
                       y = Whole(EventColumns::kY, "a row", row);
    const std::uint8_t p = filter_.Polarity(Whole(EventColumns::kPolarity, "a polarity", row));
    if (filter_.Keep(x, y))
      events->push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p);
  }

  ByteFile file_;
  NpyHeader header_;
  std::uint64_t left_;  // rows
  double micros_;
  NpyHeader::Field fields_[4];
  EventFilter filter_;
};

}  // namespace

NpyRecording::NpyRecording(const std::string& path) : path_(path) {
  ByteFile file(path);
  header_ = ReadNpyHeader(&file);
  TableSample sample;
  for (const NpyHeader::Field& field : header_.fields) {
    if (!field.name.empty()) sample.head.push_back(field.name);
  }
  for (std::uint64_t k = 0; k < std::min(header_.rows, kTelling); ++k) {
    const std::uint8_t* row = file.Take(header_.row_bytes, "the events");
    sample.rows.emplace_back();
    for (const NpyHeader::Field& field : header_.fields) sample.rows.back().push_back(Word(field, row));
  }
  if (!HoldsEvents(sample)) {
    std::string names;
    for (const NpyHeader::Field& field : header_.fields)
      names += (names.empty() ? "" : ", ") + (field.name.empty() ? "?" : field.name);
    file.Fail("holds no events (t, x, y and p by name, or rows of these four), but " +
              std::to_string(header_.rows) + " rows of: " + names);
  }
  columns_ = FindEventColumns(sample);
}

RecordingInfo NpyRecording::info() const {
  RecordingInfo info{"numpy array,", "", 0, 0};
  constexpr const char* kNames[] = {" t", " x", " y", " p", " -"};
  for (std::size_t k = 0; k < columns_.n; ++k) info.format += kNames[columns_.field[k]];
  return info;
}

std::unique_ptr<EventSource> NpyRecording::Events(int width, int height) {
  return std::make_unique<NpyEvents>(path_, columns_, width, height);
}

}  // namespace evit::formats
