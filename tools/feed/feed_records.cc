#include "tools/feed/feed_records.h"

#include <cstring>
#include <stdexcept>

#include "common/files/load_number.h"

namespace evit::feed {
namespace {

enum Kind : std::uint8_t { kEvent = 1, kImu = 2 };

}  // namespace

void AppendRecord(Utime t, std::uint16_t x, std::uint16_t y, std::uint8_t p, std::string* bytes) {
  char record[kEventBytes] = {kEvent, static_cast<char>(p)};
  std::memcpy(record + 2, &x, 2);
  std::memcpy(record + 4, &y, 2);
  std::memcpy(record + 8, &t, 8);
  bytes->append(record, sizeof record);
}

void AppendRecord(const ImuSample& sample, std::string* bytes) {
  char record[kImuBytes] = {kImu};
  std::memcpy(record + 8, &sample.t, 8);
  std::memcpy(record + 16, sample.gyro.data(), 24);
  std::memcpy(record + 40, sample.accel.data(), 24);
  bytes->append(record, sizeof record);
}

std::size_t RecordParser::ParseWhole(const std::uint8_t* data, std::size_t size, EventArray* events,
                                     std::vector<ImuSample>* imu) {
  std::size_t at = 0;
  while (at < size) {
    const std::uint8_t* record = data + at;
    const std::size_t length = record[0] == kEvent ? kEventBytes : kImuBytes;
    if (record[0] != kEvent && record[0] != kImu) {
      throw std::runtime_error("byte " + std::to_string(position_) + " of the stream: a record of kind " +
                               std::to_string(record[0]) +
                               "; known are 1 (event, 16 bytes) and 2 (IMU sample, 64 bytes), little-endian");
    }
    if (size - at < length) break;
    if (record[0] == kEvent) {
      events->push_back(LoadNumber<Utime>(record + 8), LoadNumber<std::uint16_t>(record + 2),
                        LoadNumber<std::uint16_t>(record + 4), record[1] != 0 ? 1 : 0);
    } else {
      ImuSample s;
      s.t = LoadNumber<Utime>(record + 8);
      std::memcpy(s.gyro.data(), record + 16, 24);
      std::memcpy(s.accel.data(), record + 40, 24);
      imu->push_back(s);
    }
    at += length;
    position_ += length;
  }
  return at;
}

void RecordParser::Parse(const std::uint8_t* data, std::size_t size, EventArray* events,
                         std::vector<ImuSample>* imu) {
  // The record that was cut by the last piece is completed first; the bulk is then read where it lies.
  while (!rest_.empty() && size > 0) {
    rest_.push_back(*data++);
    --size;
    if (ParseWhole(rest_.data(), rest_.size(), events, imu) == rest_.size()) rest_.clear();
  }
  const std::size_t used = ParseWhole(data, size, events, imu);
  rest_.insert(rest_.end(), data + used, data + size);
}

}  // namespace evit::feed
