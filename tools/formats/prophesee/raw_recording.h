#pragma once

#include <memory>
#include <string>

#include "tools/formats/import/recording.h"

namespace evit::formats {

/// A file of Metavision: RAW (EVT 2.0, 2.1 in both word orders, 3.0) or DAT. Events alone. Stamps count from
/// the start of the sensor. Throws std::runtime_error naming the file where it is neither, or its encoding is
/// another.
class RawRecording : public Recording {
 public:
  /// Whether a file begins like one.
  static bool Recognises(const std::string& path);

  explicit RawRecording(const std::string& path);
  RecordingInfo info() const override { return info_; }
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override { return {}; }

 private:
  enum class Encoding { kEvt2, kEvt21, kEvt21UpperFirst, kEvt3, kDat };

  std::string path_;
  RecordingInfo info_;
  Encoding encoding_ = Encoding::kEvt3;
  std::uint64_t begin_ = 0;  // of the words in the file
};

}  // namespace evit::formats
