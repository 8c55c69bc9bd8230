#pragma once

#include "common/events/event_counter.h"
#include "common/events/hot_pixels.h"
#include "common/events/keyframe_image.h"

namespace evit {

/// Signed event counts (EVPT) over half of the interval before the stamp and as long after it: the brightness
/// change around the stamp.
class EventCountImage : public KeyframeImage {
 public:
  EventCountImage(int width, int height, const SurfaceOptions& options);

  Keyframe::Encoding encoding() const override { return Keyframe::Encoding::kEventCount; }
  Span SpanOf(Utime previous, Utime stamp, double decay_us) const override;
  void Draw(const Window& window, Keyframe* keyframe) override;
  void Take(const EventArray& events, std::size_t begin, std::size_t end) override;
  void Clear() override { hot_pixels_.Clear(); }

 private:
  Utime max_lookahead_;
  HotPixels hot_pixels_;
  EventCounter counter_;
};

}  // namespace evit
