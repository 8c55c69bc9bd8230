#pragma once

#include <optional>
#include <string>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/geometry/se3.h"
#include "common/service/numbered_sender.h"
#include "evit/body_pose_t.hpp"
#include "evit/replay_control_t.hpp"
#include "procman/sheriff.h"
#include "tools/monitor/known_poses.h"
#include "tools/monitor/page_order.h"
#include "tools/monitor/pipeline_watch.h"

namespace evit::monitor {

/// Gives viewers' orders to the pipeline: REPLAY_CONTROL, POSE_HINT and, for processes that a deputy has
/// named, PM_ORDERS. A replay that is sent to a time when the body was tracked continues from where it was.
class OrderDesk : public PipelineListener {
 public:
  /// `bus`, `watch` and `sheriff` must outlive this. Becomes a listener of `watch`.
  OrderDesk(Bus* bus, const Channels& channels, PipelineWatch* watch, procman::Sheriff* sheriff);

  /// Where the body is at the begin of a recording, in the map.
  void SetStart(const SE3& T_map_body) { start_ = T_map_body; }

  /// Returns what was done, for a person. Throws std::runtime_error, saying why, where it cannot be done.
  std::string Give(const PageOrder& order);

  void OnMode(const tracker_mode_t& mode) override;

 private:
  /// The pose at the time a replay was sent to, until the tracker has got there.
  struct Sought {
    Utime t;
    SE3 T_map_body;
  };
  void Control(std::int8_t command, std::int64_t seek_utime, double speed);
  std::string Seek(double share);
  void Hint(const SE3& T_map_body);

  const PipelineWatch* watch_;
  procman::Sheriff* sheriff_;
  NumberedSender<replay_control_t> controls_;
  NumberedSender<body_pose_t> hints_;
  KnownPoses known_;
  std::optional<SE3> start_;
  std::optional<Sought> sought_;
};

}  // namespace evit::monitor
