#include "common/events/event_count_image.h"

#include <algorithm>

#include "common/time/milliseconds.h"

namespace evit {

EventCountImage::EventCountImage(int width, int height, const SurfaceOptions& options)
    : max_lookahead_(MaxLookahead(options)),
      hot_pixels_(width, height, options.hot_pixel_rate_hz),
      counter_(width, height) {}

KeyframeImage::Span EventCountImage::SpanOf(Utime previous, Utime stamp, double /*decay_us*/) const {
  const Utime half = (stamp - previous) / 2;
  return {stamp - half, std::min(max_lookahead_, half)};
}

void EventCountImage::Draw(const Window& window, Keyframe* keyframe) {
  const auto begin = std::chrono::steady_clock::now();
  const auto& t = window.events.t;
  const auto first =
      std::upper_bound(t.begin() + static_cast<std::ptrdiff_t>(window.begin),
                       t.begin() + static_cast<std::ptrdiff_t>(window.end), keyframe->from_utime);
  keyframe->surface = counter_.Count(window.events, static_cast<std::size_t>(first - t.begin()), window.end,
                                     hot_pixels_.pixels());
  const auto counted = std::chrono::steady_clock::now();
  Take(window.events, window.begin, window.stamp);
  hot_pixels_.AdvanceTo(keyframe->utime);
  keyframe->render_ms = Milliseconds(counted - begin);
  keyframe->update_ms = Milliseconds(std::chrono::steady_clock::now() - counted);
}

void EventCountImage::Take(const EventArray& events, std::size_t begin, std::size_t end) {
  hot_pixels_.Update(events, begin, end);
}

}  // namespace evit
