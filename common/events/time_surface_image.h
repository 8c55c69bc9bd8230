#pragma once

#include "common/events/active_event_surface.h"
#include "common/events/hot_pixels.h"
#include "common/events/keyframe_image.h"
#include "common/events/surface_renderer.h"

namespace evit {

/// The negated time surface at the stamp, drawn from the surface of active events (paper Sec. III-B.2).
class TimeSurfaceImage : public KeyframeImage {
 public:
  TimeSurfaceImage(int width, int height, const SurfaceOptions& options);

  Keyframe::Encoding encoding() const override { return Keyframe::Encoding::kTimeSurface; }
  Span SpanOf(Utime previous, Utime stamp, double decay_us) const override;
  void Draw(const Window& window, Keyframe* keyframe) override;
  void Take(const EventArray& events, std::size_t begin, std::size_t end) override;
  void Clear() override;

 private:
  Utime max_lookahead_;
  double truncation_;
  ActiveEventSurface surface_;
  HotPixels hot_pixels_;
  SurfaceRenderer renderer_;
};

}  // namespace evit
