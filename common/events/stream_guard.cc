#include "common/events/stream_guard.h"

#include <algorithm>
#include <vector>

#include "common/events/event_order.h"
#include "common/simd/lanes.h"
#include "common/time/time_order.h"

namespace evit {
namespace {

EVIT_MULTIVERSION Utime LongestStep(const Utime* t, std::size_t n) {
  Utime longest = 0;
  for (std::size_t k = 1; k < n; ++k) longest = std::max(longest, t[k] - t[k - 1]);
  return longest;
}

struct Event {
  Utime t;
  std::uint16_t x, y;
  std::uint8_t p;
};

}  // namespace

void StreamGuard::Sort(EventArray* events) {
  if (NeverDecreases(events->t.data(), events->size())) return;
  std::vector<Event> list;
  for (std::size_t k = 0; k < events->size(); ++k)
    list.push_back({events->t[k], events->x[k], events->y[k], events->p[k]});
  TimeOrderCounts counts;
  list = InTimeOrder(list, {}, &counts);
  counters_.events_ahead += counts.outlier + counts.late;
  counters_.events_sorted += counts.sorted;
  events->clear();
  for (const Event& e : list) events->push_back(e.t, e.x, e.y, e.p);
}

EventArray StreamGuard::CutAtJump(EventArray* events) {
  EventArray rest;
  if (LongestStep(events->t.data(), events->size()) <= AheadGuard<Packet>::kAhead) return rest;
  for (std::size_t k = 1; k < events->size(); ++k) {
    if (events->t[k] - events->t[k - 1] <= AheadGuard<Packet>::kAhead) continue;
    const auto at = static_cast<std::ptrdiff_t>(k);
    rest.t.assign(events->t.begin() + at, events->t.end());
    rest.x.assign(events->x.begin() + at, events->x.end());
    rest.y.assign(events->y.begin() + at, events->y.end());
    rest.p.assign(events->p.begin() + at, events->p.end());
    for (auto* column : {&events->x, &events->y}) column->resize(k);
    events->t.resize(k);
    events->p.resize(k);
    break;
  }
  return rest;
}

}  // namespace evit
