#pragma once

#include <ostream>

#include "common/evaluation/trajectory.h"

namespace evit::formats {

/// An MCAP file (mcap.dev/spec; no chunks, no index) of geometry_msgs/msg/PoseStamped on /evit/pose, in frame
/// `map`.
void WritePosesMcap(std::ostream& out, const Trajectory& trajectory);

}  // namespace evit::formats
