#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/geometry/se3.h"

namespace evit::monitor {

/// What a viewer asks for. Nothing else exists: no path, no command line.
struct PageOrder {
  enum class Kind {
    kAcknowledge,  // the picture of `drawn_utime` was drawn
    kRestart,      // `command`
    kPause,
    kResume,
    kSeek,  // to `seek_share`
    kSpeed,
    kHint  // `T_map_body`
  };
  Kind kind = Kind::kAcknowledge;
  double drawn_utime = 0;  // kAcknowledge: us, sensor clock; 0: not told
  std::string command;     // kRestart: id of a process, as the deployment names it
  double seek_share = 0;   // kSeek: 0..1 of the recording
  double speed = 1;        // kSpeed: 1 real time; 0 < speed <= 100
  SE3 T_map_body;          // kHint: m, map frame

  /// Orders change what the pipeline does; an acknowledgement does not.
  bool changes_pipeline() const { return kind != Kind::kAcknowledge; }
};

/// Reads an order, JSON of at most 4 kB: {"order": "restart", "command": "map_server"}, {"order": "pause"},
/// {"order": "resume"}, {"order": "seek", "share": 0.5}, {"order": "speed", "speed": 2},
/// {"order": "hint", "position": [x, y, z], "orientation": [x, y, z, w]}, {"order": "drawn", "utime": 0}
/// (utime may be missing). Throws std::runtime_error saying what is wrong with it.
PageOrder ParsePageOrder(std::string_view text);

}  // namespace evit::monitor
