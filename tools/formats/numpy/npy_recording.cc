#include "tools/formats/numpy/npy_recording.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/formats/import/event_filter.h"
#include "tools/formats/numpy/npy_imu.h"

namespace evit::formats {
namespace {

constexpr std::uint64_t kPiece = 100'000;  // events

class NpyEvents : public EventSource {
 public:
  NpyEvents(const NpyTable& table, const EventColumns& columns, int width, int height)
      : name_(table.path + (table.name.empty() ? "" : ": " + table.name)),
        rows_(table),
        unit_(columns.unit),
        filter_(width, height) {
    for (std::size_t k = 0; k < columns.n; ++k) {
      if (columns.field[k] != EventColumns::kIgnored)
        fields_[columns.field[k]] = {k, table.columns[k].numbers};
    }
  }

  bool Read(EventArray* events) override {
    events->clear();
    while (events->size() == 0) {
      const std::uint64_t n = rows_.Read(kPiece);
      if (n == 0) return false;
      for (std::uint64_t k = 0; k < n; ++k) Add(k, events);
    }
    return true;
  }
  double share() const override { return rows_.share(); }
  std::string name() const override { return name_; }
  DropCounts dropped() const override { return filter_.dropped(); }

 private:
  struct Field {
    std::size_t column = 0;
    NpyColumn numbers;
  };

  std::int64_t Whole(EventColumns::Field which, const char* what, std::uint64_t row) const {
    const Field& field = fields_[which];
    const std::uint8_t* at = rows_.At(field.column, row);
    if (field.numbers.kind != 'f') return NpyInteger(field.numbers, at);
    const double value = NpyNumber(field.numbers, at);
    if (!(std::abs(value) < 1e15) || value != std::floor(value))
      throw std::runtime_error(name_ + ": " + what + " is " + std::to_string(value) +
                               ", which is not a whole number");
    return static_cast<std::int64_t>(value);
  }
  // False where it is none.
  bool Time(std::uint64_t row, Utime* t) const {
    const Field& time = fields_[EventColumns::kTime];
    const std::uint8_t* at = rows_.At(time.column, row);
    if (time.numbers.kind != 'f' && unit_ == TimeUnit::kMicroseconds) {
      *t = NpyInteger(time.numbers, at);
      return true;
    }
    if (!NpyTime(time.numbers, at, unit_, t)) return false;
    constexpr double kFloatResolution = 1.2e-7;  // of 32 bits
    if (time.numbers.kind == 'f' && time.numbers.bytes < 8 &&
        std::abs(static_cast<double>(*t)) * kFloatResolution >= 1) {
      throw std::runtime_error(
          name_ +
          ": holds stamps as 32-bit floats, which do not resolve a microsecond after 8 s: "
          "save them as int64 or float64");
    }
    if (fields_[EventColumns::kNanoseconds].numbers.bytes > 0)
      *t += Whole(EventColumns::kNanoseconds, "nanoseconds", row) / 1000;
    return true;
  }
  void Add(std::uint64_t row, EventArray* events) {
    Utime t = 0;
    if (!Time(row, &t)) return filter_.CountInvalid();
    const std::int64_t x = Whole(EventColumns::kX, "a column", row),
                       y = Whole(EventColumns::kY, "a row", row);
    const std::uint8_t p = Polarity(Whole(EventColumns::kPolarity, "a polarity", row));
    if (filter_.Keep(x, y))
      events->push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p);
  }
  std::uint8_t Polarity(std::int64_t value) {
    try {
      return filter_.Polarity(value);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(name_ + ": " + error.what());
    }
  }

  std::string name_;
  NpyRows rows_;
  TimeUnit unit_;
  Field fields_[EventColumns::kIgnored];
  EventFilter filter_;
};

std::string NamesOf(const NpyTable& table) {
  std::string names;
  if (table.columns.size() > 4 && table.columns.front().numbers.name.empty()) {
    return std::to_string(table.columns.size()) +
           " numbers without names (of an array a whose first four columns are the events': "
           "numpy.save('events.npy', a[:, :4]))";
  }
  for (const NpyTable::Column& column : table.columns)
    names += (names.empty() ? "" : ", ") + (column.numbers.name.empty() ? "?" : column.numbers.name);
  return names;
}

}  // namespace

NpyRecording::NpyRecording(const std::string& path, const std::string& requested) {
  std::vector<NpyTable> found;
  std::string others, choices;
  for (NpyTable& table : FindNpyTables(path)) {
    const TableSample sample = SampleNpy(table);
    if (!HoldsEvents(sample)) {
      others += (others.empty() ? "" : "; ") + (table.name.empty() ? "" : table.name + ": ") +
                std::to_string(table.rows) + " rows of: " + NamesOf(table);
      continue;
    }
    choices += (choices.empty() ? "" : ", ") + (table.name.empty() ? "/" : table.name);
    if (!requested.empty() && table.name != requested && "/" + table.name != requested) continue;
    columns_ = FindEventColumns(sample);
    found.push_back(std::move(table));
  }
  ReadNpyImu(path, &streams_);
  if (choices.empty()) {
    missing_ = path + ": holds no events (t, x, y and p by name, or rows of these four), but " +
               (others.empty() ? "no array with rows" : others);
    if (streams_.imu.empty()) throw std::runtime_error(missing_);
    return;
  }
  if (found.size() != 1)
    throw std::runtime_error(path + ": choose the events to take with --events-topic: " + choices);
  table_ = std::move(found.front());
}

RecordingInfo NpyRecording::info() const {
  if (!has_events()) return {"numpy, IMU alone", "", 0, 0};
  RecordingInfo info{std::string(IsNpz(table_.path) ? "numpy archive" : "numpy array") +
                         (table_.name.empty() ? "" : " " + table_.name) + ",",
                     "", 0, 0};
  constexpr const char* kNames[] = {" t", " x", " y", " p", " ns", " -"};
  for (std::size_t k = 0; k < columns_.n; ++k) info.format += kNames[columns_.field[k]];
  return info;
}

std::unique_ptr<EventSource> NpyRecording::Events(int width, int height) {
  if (!has_events()) throw std::runtime_error(missing_);
  return std::make_unique<NpyEvents>(table_, columns_, width, height);
}

}  // namespace evit::formats
