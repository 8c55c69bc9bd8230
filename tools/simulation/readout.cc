#include "tools/simulation/readout.h"

#include <algorithm>
#include <cmath>

namespace evit::simulation {

Readout::Readout(const ReadoutSettings& settings, std::uint64_t seed)
    : settings_(settings), random_(seed, 0xB0257) {}

void Readout::AddBursts(std::int32_t until, std::vector<EventSensor::Event>* events) {
  const double mean_us = 1e3 * settings_.burst_gap_ms;
  const std::size_t n = events->size();
  for (std::size_t k = 0; k < n; ++k) {
    EventSensor::Event again = (*events)[k];
    while (random_.Chance(settings_.burst_share)) {
      again.t += 1 + static_cast<std::int32_t>(random_.Exponential(mean_us));
      later_.push_back(again);
    }
  }
  const auto due = std::stable_partition(later_.begin(), later_.end(),
                                         [until](const EventSensor::Event& e) { return e.t > until; });
  events->insert(events->end(), due, later_.end());
  later_.erase(due, later_.end());
  std::stable_sort(events->begin(), events->end(),
                   [](const EventSensor::Event& a, const EventSensor::Event& b) { return a.t < b.t; });
}

void Readout::Pass(std::int32_t until, std::vector<EventSensor::Event>* events) {
  if (settings_.burst_share > 0) AddBursts(until, events);
  if (settings_.rate_hz <= 0) return;
  const double gap = 1e6 / settings_.rate_hz, patience = 1e3 * settings_.patience_ms;
  std::size_t kept = 0;
  for (EventSensor::Event event : *events) {
    const double leaves = std::max<double>(event.t, free_from_);
    if (leaves - event.t > patience) {
      ++lost_;
      continue;
    }
    free_from_ = leaves + gap;
    event.t = static_cast<std::int32_t>(std::ceil(leaves));
    (*events)[kept++] = event;
  }
  events->resize(kept);
}

}  // namespace evit::simulation
