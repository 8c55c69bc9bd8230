#pragma once

#include <memory>
#include <string>

#include "tools/formats/aedat/aedat_decoder.h"
#include "tools/formats/import/recording.h"

namespace evit::formats {

/// An AEDAT 2.0 file of jAER or 3.1 file of cAER (docs.inivation.com, AEDAT file formats): events and a
/// DAVIS's IMU. Throws std::runtime_error naming the file where its version is another.
class AedatRecording : public Recording {
 public:
  static bool Recognises(const std::string& path);

  explicit AedatRecording(const std::string& path);
  RecordingInfo info() const override { return info_; }
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override;

 private:
  std::unique_ptr<AedatDecoder> Decoder() const;

  std::string path_;
  RecordingInfo info_;
  bool version_3_ = false;
  std::uint64_t begin_ = 0;  // of what follows the header
};

}  // namespace evit::formats
