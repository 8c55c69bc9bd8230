#include "tools/formats/import/event_filter.h"

#include <algorithm>

namespace evit::formats {

// One pass without branches over each array.
bool EventFilter::AllGood(const EventArray& events) const {
  const std::size_t n = events.size();
  std::uint16_t x = 0, y = 0;
  for (std::size_t k = 0; k < n; ++k) x = std::max(x, events.x[k]);
  for (std::size_t k = 0; k < n; ++k) y = std::max(y, events.y[k]);
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
