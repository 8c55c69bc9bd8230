#include "common/events/time_surface_image.h"

#include <algorithm>

#include "common/time/milliseconds.h"

namespace evit {

TimeSurfaceImage::TimeSurfaceImage(int width, int height, const SurfaceOptions& options)
    : max_lookahead_(MaxLookahead(options)),
      truncation_(options.truncation),
      surface_(width, height),
      hot_pixels_(width, height, options.hot_pixel_rate_hz),
      renderer_(width, height, options) {}

KeyframeImage::Span TimeSurfaceImage::SpanOf(Utime /*previous*/, Utime stamp, double decay_us) const {
  // Later events than this would not show: the faster the motion, the shorter the wait.
  return {stamp, std::min(max_lookahead_, static_cast<Utime>(VisibleUs(decay_us, truncation_)))};
}

void TimeSurfaceImage::Draw(const Window& window, Keyframe* keyframe) {
  const auto begin = std::chrono::steady_clock::now();
  Take(window.events, window.begin, window.stamp);
  hot_pixels_.AdvanceTo(keyframe->utime);
  const auto updated = std::chrono::steady_clock::now();
  SurfaceRenderer::View view;
  view.t = keyframe->utime;
  view.decay_us = keyframe->decay_us;
  view.after = &window.events;
  view.begin = window.stamp;
  view.end = window.end;
  view.ignored = &hot_pixels_.pixels();
  keyframe->surface = renderer_.Render(surface_, view);
  keyframe->update_ms = Milliseconds(updated - begin);
  keyframe->render_ms = Milliseconds(std::chrono::steady_clock::now() - updated);
}

void TimeSurfaceImage::Take(const EventArray& events, std::size_t begin, std::size_t end) {
  surface_.Update(events.t.data() + begin, events.x.data() + begin, events.y.data() + begin, end - begin);
  hot_pixels_.Update(events, begin, end);
}

void TimeSurfaceImage::Clear() {
  surface_.Clear();
  hot_pixels_.Clear();
}

}  // namespace evit
