#pragma once

#include <memory>
#include <string>

#include "tools/formats/import/event_columns.h"
#include "tools/formats/import/recording.h"
#include "tools/formats/numpy/npy_table.h"

namespace evit::formats {

/// Events in numpy's files: an array (.npy), structured with t, x, y and p by name, or of rows of four
/// numbers, whose order and unit of time the values tell as in text (FindEventColumns); or an archive (.npz)
/// with such an array, or with one array for each of t, x, y and p.
class NpyRecording : public Recording {
 public:
  static bool Recognises(const std::string& path) { return IsNpy(path) || IsNpz(path); }

  /// `requested`: of several in an archive, the array to take, or what is before the slash in the names of
  /// its arrays. Throws std::runtime_error naming the file and what is wrong. Without events there may still
  /// be an IMU (ReadNpyImu); Events() then throws.
  explicit NpyRecording(const std::string& path, const std::string& requested = "");
  RecordingInfo info() const override;
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override { return streams_; }
  bool has_events() const { return missing_.empty(); }

 private:
  ImportStreams streams_;
  std::string missing_;  // why there are no events
  NpyTable table_;
  EventColumns columns_;
};

}  // namespace evit::formats
