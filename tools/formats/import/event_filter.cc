#include "tools/formats/import/event_filter.h"

#include <algorithm>

namespace evit::formats {

// One pass without branches over each array.
bool EventFilter::AllGood(const EventArray& events) {
  constexpr std::uint16_t kLargest = 65535;
  std::uint16_t low_x = kLargest, low_y = kLargest, x = 0, y = 0;
  for (const std::uint16_t column : events.x) low_x = std::min(low_x, column), x = std::max(x, column);
  for (const std::uint16_t row : events.y) low_y = std::min(low_y, row), y = std::max(y, row);
  if (events.size() > 0) extent_.Add(low_x, low_y), extent_.Add(x, y);
  return x < width_ && y < height_;
}

void EventFilter::Apply(EventArray* events) {
  if (AllGood(*events)) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < events->size(); ++k) {
    if (!Keep(events->x[k], events->y[k])) continue;
    events->t[kept] = events->t[k];
    events->x[kept] = events->x[k];
    events->y[kept] = events->y[k];
    events->p[kept++] = events->p[k];
  }
  events->t.resize(kept), events->x.resize(kept), events->y.resize(kept), events->p.resize(kept);
}

}  // namespace evit::formats
