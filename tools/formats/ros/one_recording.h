#pragma once

#include <string>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// The topics that an import takes; empty: none.
struct TakenTopics {
  std::string events, imu, truth;
};

/// Whether the files of a bag belong together: those with events follow one another without a hole of more
/// than two seconds, but after one that is cut off, as a recorder splits a long recording, or none but one
/// has events; and IMU and truth are of the same time as the events. By when the messages were recorded.
/// Throws std::runtime_error naming the files that do not fit, their times and the remedy.
void RequireOneRecording(const std::vector<BagPart>& parts, const TakenTopics& taken);

}  // namespace evit::formats
