#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/events/event.h"
#include "common/files/whole_file.h"

namespace evit::formats {

/// Writes a Metavision RAW file in EVT 3.0 that RawRecording and other tools read. Its stamps count from
/// `start`: the format has no absolute time. The file appears whole or not at all.
class Evt3Writer {
 public:
  Evt3Writer(const std::string& path, int width, int height, Utime start);

  /// Further events in order of time, none before `start`. Throws std::runtime_error naming the file
  /// otherwise.
  void Append(const EventArray& events);
  void Close();

 private:
  void Put(unsigned type, unsigned payload) {
    words_.push_back(static_cast<std::uint16_t>(type << 12 | payload));
  }
  void PutTime(Utime t);

  std::string path_;
  WholeFile file_;
  Utime start_, last_ = 0;
  int y_ = -1;
  bool stamped_ = false;
  std::vector<std::uint16_t> words_;
};

}  // namespace evit::formats
