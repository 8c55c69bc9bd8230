#pragma once

#include <memory>
#include <string>

#include "tools/formats/import/event_columns.h"
#include "tools/formats/import/recording.h"
#include "tools/formats/numpy/npy_header.h"

namespace evit::formats {

/// Events in a numpy array (.npy): structured with t, x, y and p by name, or rows of four numbers, whose
/// order and unit of time the values tell as in text (FindEventColumns).
class NpyRecording : public Recording {
 public:
  static bool Recognises(const std::string& path) { return IsNpy(path); }

  /// Throws std::runtime_error naming the file and what is wrong.
  explicit NpyRecording(const std::string& path);
  RecordingInfo info() const override;
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override { return {}; }

 private:
  std::string path_;
  NpyHeader header_;
  EventColumns columns_;
};

}  // namespace evit::formats
