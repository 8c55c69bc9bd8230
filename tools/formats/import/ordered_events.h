#pragma once

#include <string>

#include "common/time/time_order.h"
#include "tools/formats/import/counter_wrap.h"
#include "tools/formats/import/event_source.h"

namespace evit::formats {

/// The events of a source in order of time: counters that wrap are continued (CounterWrap), small disorder is
/// sorted, stamps far ahead or beyond any date are dropped (TimeOrder).
class OrderedEvents : public EventSource {
 public:
  /// `source` must outlive this.
  explicit OrderedEvents(EventSource* source) : source_(source) {}

  bool Read(EventArray* events) override;
  double share() const override { return source_->share(); }
  std::string name() const override { return source_->name(); }
  DropCounts dropped() const override;

 private:
  struct Event {
    Utime t;
    std::uint16_t x, y;
    std::uint8_t p;
  };
  EventSource* source_;
  CounterWrap wrap_;
  TimeOrder<Event> order_;
  EventArray piece_;
  bool more_ = true;
  std::int64_t n_impossible_ = 0;
};

}  // namespace evit::formats
