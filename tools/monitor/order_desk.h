#pragma once

#include <string>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/service/numbered_sender.h"
#include "evit/body_pose_t.hpp"
#include "evit/replay_control_t.hpp"
#include "procman/sheriff.h"
#include "tools/monitor/page_order.h"
#include "tools/monitor/pipeline_watch.h"

namespace evit::monitor {

/// Gives viewers' orders to the pipeline: REPLAY_CONTROL, POSE_HINT and, for processes that a deputy has
/// named, PM_ORDERS.
class OrderDesk {
 public:
  /// `bus`, `watch` and `sheriff` must outlive this.
  OrderDesk(Bus* bus, const Channels& channels, const PipelineWatch* watch, procman::Sheriff* sheriff);

  /// Returns what was done, for a person. Throws std::runtime_error, saying why, where it cannot be done.
  std::string Give(const PageOrder& order);

 private:
  void Control(std::int8_t command, std::int64_t seek_utime, double speed);
  std::string Seek(double share);

  const PipelineWatch* watch_;
  procman::Sheriff* sheriff_;
  NumberedSender<replay_control_t> controls_;
  NumberedSender<body_pose_t> hints_;
};

}  // namespace evit::monitor
