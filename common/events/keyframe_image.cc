#include "common/events/keyframe_image.h"

#include <cmath>

#include "common/events/event_count_image.h"
#include "common/events/time_surface_image.h"

namespace evit {

Utime MaxLookahead(const SurfaceOptions& options) {
  return options.kind == SurfaceOptions::Kind::kSymmetric ? std::llround(options.lookahead_ms * 1e3) : 0;
}

std::unique_ptr<KeyframeImage> MakeKeyframeImage(Keyframe::Encoding encoding, int width, int height,
                                                 const SurfaceOptions& options) {
  if (encoding == Keyframe::Encoding::kEventCount) {
    return std::make_unique<EventCountImage>(width, height, options);
  }
  return std::make_unique<TimeSurfaceImage>(width, height, options);
}

}  // namespace evit
