#pragma once

#include <string>

#include "tools/formats/import/recording.h"

namespace evit::formats {

/// Events in a text file, `t x y p` a row, alone.
class TextRecording : public Recording {
 public:
  /// Whether a file begins as a table of events (HoldsEvents).
  static bool Recognises(const std::string& path);

  explicit TextRecording(const std::string& path) : path_(path) {}
  RecordingInfo info() const override;
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override { return {}; }

 private:
  std::string path_;
};

}  // namespace evit::formats
