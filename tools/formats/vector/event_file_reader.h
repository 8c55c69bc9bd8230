#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "common/events/event.h"

namespace evit::formats {

/// Reads what EventFileWriter describes, and what others write in its layout: numbers of any type as long as
/// they have one meaning. Pixels may be floats without fractions; polarities 0/1, -1/1 or bool
/// (PolarityCode); stamps integers in us after t_offset, or floats in s (or us, ns: by what they can be);
/// t_offset may be missing (TUM-VIE), then it is 0. A 32-bit counter of us that starts again from 0
/// continues. All functions throw std::runtime_error naming the file, the dataset and what is wrong.
class EventFileReader {
 public:
  explicit EventFileReader(const std::string& path);
  ~EventFileReader();
  std::size_t size() const;  // events in the file
  /// Reads up to `max_events` further events (absolute stamps) into `events` (replaced), in the file's order.
  /// Those whose pixel no sensor has (negative, beyond 65535) are left out. Returns how many of the file's
  /// were read; 0 at the end.
  std::size_t Read(std::size_t max_events, EventArray* events);
  /// How many were left out so far.
  std::int64_t n_impossible() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace evit::formats
