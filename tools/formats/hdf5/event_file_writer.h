#pragma once

#include <memory>
#include <string>

#include "common/events/event.h"

namespace evit::formats {

/// Writes VECtor's `*.synced.left_event.hdf5` (DSEC layout): events/{x u16, y u16, p u8, t u32 us after
/// t_offset}, t_offset i64[1] us, ms_to_idx u64. Chunked; Zstandard filter 32015, registered in process (no
/// plug-in needed). All functions throw std::runtime_error naming the file, the dataset and what is wrong.
class EventFileWriter {
 public:
  /// Writes `path`.part; Close() renames it to `path`. Without Close() the part file is removed.
  EventFileWriter(const std::string& path, Utime t_offset);
  ~EventFileWriter();
  void Append(const EventArray& events);  // sorted, all at or after t_offset
  void Close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace evit::formats
