#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/formats/hdf5/h5_events.h"
#include "tools/formats/import/recording.h"

namespace evit::formats {

/// Recordings in HDF5 as DSEC, TUM-VIE, M3ED, MVSEC, EDS, VECtor and Prophesee publish them: one file with
/// the events; further ones may hold IMU (M3ED, MVSEC) and truth (`*_gt`). Of two cameras the left one, or
/// the group asked for.
class H5Recording : public Recording {
 public:
  static bool Recognises(const std::string& path) { return H5File::Recognises(path); }

  /// Throws std::runtime_error naming the file and its datasets where none holds events.
  H5Recording(const std::vector<std::string>& paths, const std::string& group);
  RecordingInfo info() const override { return info_; }
  std::unique_ptr<EventSource> Events(int width, int height) override;
  ImportStreams Streams() override;

 private:
  std::vector<H5File> files_;
  std::size_t events_file_ = 0;
  H5EventLayout layout_;
  RecordingInfo info_;
};

}  // namespace evit::formats
