#include "common/events/event_clock.h"

#include <algorithm>

namespace evit {

std::optional<EventClock::Tick> EventClock::Next(const StreamMerger& merger) {
  if (!running_ && !Start(merger)) return std::nullopt;
  See(merger);
  if (tick_ - newest_ > kRest) {
    if (merger.PositionAfter(tick_) == merger.end()) return std::nullopt;
    tick_ = newest_ = merger.StampAt(merger.PositionAfter(tick_));
    begins_ = true;
  }
  // Once the streams have ended all is known, and nothing more comes.
  if (merger.ended() ? tick_ > merger.newest_event() : !merger.Knows(tick_)) return std::nullopt;
  return Tick{tick_, begins_};
}

bool EventClock::Start(const StreamMerger& merger) {
  if ((patience_ > 0 && merger.has_imu()) || !merger.has_events() ||
      !merger.Knows(merger.first_event() + patience_) || merger.first() == merger.end())
    return false;
  running_ = true;
  position_ = merger.first();
  tick_ = newest_ = merger.StampAt(position_);
  if (!from_first_event_ && !merger.ended()) tick_ = std::max(tick_, merger.first_event() + patience_);
  return true;
}

// Events are released once they have been drawn: what is asked here has to be remembered.
void EventClock::See(const StreamMerger& merger) {
  const std::int64_t position = merger.PositionAfter(tick_);
  if (position > position_ && position > merger.first()) newest_ = merger.StampAt(position - 1);
  position_ = position;
}

void EventClock::Pop() {
  tick_ += kStep;
  begins_ = false;
}

}  // namespace evit
