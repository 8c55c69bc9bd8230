#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/geometry/camera.h"
#include "common/service/status_reporter.h"
#include "evit/keyframe_t.hpp"

namespace evit {

/// Decodes KEYFRAME and turns away what this optimiser cannot use: broken messages are counted as
/// KEYFRAME.invalid; keyframes made with other settings also fail the service's STATUS, which says what to
/// do.
class KeyframeInbox {
 public:
  /// Expects surfaces of this `encoding` (keyframe_t::TIME_SURFACE or EVENT_COUNT) and camera size. `status`
  /// must outlive this.
  KeyframeInbox(StatusReporter* status, std::int8_t encoding, const Camera& camera);

  std::optional<keyframe_t> Decode(const std::uint8_t* data, std::size_t size);

 private:
  StatusReporter* status_;
  std::int8_t encoding_;
  int width_, height_;  // pixels
};

}  // namespace evit
