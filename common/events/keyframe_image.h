#pragma once

#include <cstddef>
#include <memory>

#include "common/events/event.h"
#include "common/events/keyframe.h"
#include "common/events/surface_options.h"

namespace evit {

/// What a keyframe shows of the events around its stamp. Events are handed over once each, in order of time.
class KeyframeImage {
 public:
  /// Events after `from`, up to the stamp + `lookahead`, show in the image.
  struct Span {
    Utime from, lookahead;
  };
  /// Consecutive events: [begin, stamp) up to the keyframe's stamp and not handed over before, [stamp, end)
  /// later ones, up to its look-ahead.
  struct Window {
    const EventArray& events;
    std::size_t begin, stamp, end;
  };

  virtual ~KeyframeImage() = default;

  virtual Keyframe::Encoding encoding() const = 0;
  /// What the image of the keyframe at `stamp` shows, `previous` being the stamp of the one before.
  virtual Span SpanOf(Utime previous, Utime stamp, double decay_us) const = 0;
  /// Fills in the keyframe's image, and how long that took. Takes the events [begin, stamp).
  virtual void Draw(const Window& window, Keyframe* keyframe) = 0;
  /// Takes the events [begin, end) without drawing anything.
  virtual void Take(const EventArray& events, std::size_t begin, std::size_t end) = 0;
  /// Forgets all events.
  virtual void Clear() = 0;
};

/// us: how far events after a stamp count, at most.
Utime MaxLookahead(const SurfaceOptions& options);

/// Both sides of the image in pixels.
std::unique_ptr<KeyframeImage> MakeKeyframeImage(Keyframe::Encoding encoding, int width, int height,
                                                 const SurfaceOptions& options);

}  // namespace evit
