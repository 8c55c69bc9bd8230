#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "common/events/event.h"

namespace evit::formats {

/// Reads what EventFileWriter describes. All functions throw std::runtime_error naming the file, the dataset
/// and what is wrong.
class EventFileReader {
 public:
  explicit EventFileReader(const std::string& path);
  ~EventFileReader();
  std::size_t size() const;  // events in the file
  /// Reads up to `max_events` further events (absolute stamps) into `events` (replaced). Returns how many; 0
  /// at the end.
  std::size_t Read(std::size_t max_events, EventArray* events);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace evit::formats
