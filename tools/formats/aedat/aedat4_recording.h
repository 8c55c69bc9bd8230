#pragma once

#include <memory>
#include <string>

#include "tools/formats/aedat/aedat4_packets.h"
#include "tools/formats/import/recording.h"

namespace evit::formats {

/// An AEDAT 4 file of DV. Frames and triggers are passed over.
class Aedat4Recording : public Recording {
 public:
  static bool Recognises(const std::string& path) { return Aedat4Packets::Recognises(path); }

  /// Of several streams of events or IMU samples `events` and `imu` choose one, by its number or by its
  /// camera (empty: the only one; of the camera whose events are taken). `take_events` false: only its IMU is
  /// of interest. Throws std::runtime_error naming the file and the streams where they do not.
  explicit Aedat4Recording(const std::string& path, const std::string& events = "",
                           const std::string& imu = "", bool take_events = true);
  RecordingInfo info() const override { return info_; }
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override;

 private:
  std::string path_;
  RecordingInfo info_;
  int events_ = -1, imu_ = -1;  // streams; -1: none
};

}  // namespace evit::formats
