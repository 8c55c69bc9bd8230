#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "common/geometry/se3.h"
#include "common/time/utime.h"
#include "tools/monitor/pipeline_watch.h"

namespace evit::monitor {

/// Where the body was at every time of a recording that has been tracked, so that a replay which is sent to
/// such a time continues from there. Ten poses a second, of the newest pass over that time; of a recording
/// longer than an hour the latest times are not kept.
class KnownPoses : public PipelineListener {
 public:
  void OnWindow(const window_state_t& window, double latency_ms) override;

  /// T_map_body at `t`, us of the sensor clock; nullopt where nothing within 0.3 s of it was tracked.
  std::optional<SE3> At(Utime t) const;

  static constexpr std::size_t kMost = 36'000;  // 3 MB

 private:
  struct Known {
    Utime t;
    SE3 T_map_body;
  };
  std::map<std::int64_t, Known> poses_;  // by tenth of a second
};

}  // namespace evit::monitor
