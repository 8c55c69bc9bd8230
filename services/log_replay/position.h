#pragma once

#include <array>
#include <cstdint>

namespace evit {

/// Where a replay is: what its successor needs to continue as the very same stream.
struct ReplayPosition {
  std::int64_t next = 0;                             // message of the recording
  std::int64_t epoch = 0;                            // of the stream
  std::array<std::int64_t, 3> sent{}, last_utime{};  // StreamSender's, by Recording::Kind
  std::int64_t ended = 0, paused = 0;                // flags
  double speed = 1;
};

}  // namespace evit
