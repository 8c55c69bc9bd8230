#include "common/diagnosis/event_excerpts.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace evit::diagnosis {

EventExcerpts::EventExcerpts(std::vector<Utime> instants, Utime reach)
    : instants_(std::move(instants)), reach_(reach), events_(instants_.size()) {}

void EventExcerpts::Add(const EventArray& events) {
  if (events.size() == 0) return;
  for (std::size_t k = 0; k < instants_.size(); ++k) {
    if (instants_[k] + reach_ < events.t.front() || instants_[k] - reach_ > events.t.back()) continue;
    for (std::size_t e = 0; e < events.size(); ++e) {
      if (std::abs(events.t[e] - instants_[k]) <= reach_)
        events_[k].push_back(events.t[e], events.x[e], events.y[e], events.p[e]);
    }
  }
}

}  // namespace evit::diagnosis
