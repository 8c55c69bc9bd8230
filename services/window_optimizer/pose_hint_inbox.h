#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/geometry/se3.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"

namespace evit {

/// POSE_HINT: somebody says where the body is. Holds the newest hint until it is taken.
class PoseHintInbox {
 public:
  explicit PoseHintInbox(StatusReporter* status) : counter_(status, "POSE_HINT") {}

  /// A message of the channel; one that is broken or older than the last is left out and counted.
  void OnMessage(const std::uint8_t* data, std::size_t size);

  /// T_map_body, once.
  std::optional<SE3> Take();

 private:
  SequenceCounter counter_;
  std::optional<SE3> hint_;
};

}  // namespace evit
