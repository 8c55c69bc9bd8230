#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace evit {

/// Where a replay is: what its successor needs to go on as the very same stream.
struct ReplayPosition {
  std::int64_t next = 0;                             // message of the recording
  std::int64_t epoch = 0;                            // of the stream
  std::array<std::int64_t, 3> sent{}, last_utime{};  // StreamSender's, by Recording::Kind
  std::int64_t ended = 0, paused = 0;                // flags
  double speed = 1;
};

/// Keeps a ReplayPosition in a file that is mapped into memory: storing costs some nanoseconds, and what was stored
/// last is there even if this process is killed at that very moment.
class PositionFile {
 public:
  /// `recording`: a number that tells this recording from others; a position of another one is not loaded. The
  /// file is made where it is not there. Throws std::runtime_error where it cannot be.
  PositionFile(const std::string& path, std::int64_t recording);
  ~PositionFile();
  PositionFile(const PositionFile&) = delete;
  PositionFile& operator=(const PositionFile&) = delete;

  /// None where nothing was stored, or of another recording.
  std::optional<ReplayPosition> Load() const;
  void Store(const ReplayPosition& position);
  void Clear();

 private:
  struct Page;
  std::int64_t recording_;
  Page* page_ = nullptr;
};

}  // namespace evit
