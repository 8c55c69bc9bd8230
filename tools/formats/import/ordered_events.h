#pragma once

#include <string>

#include "common/time/time_order.h"
#include "tools/formats/import/event_source.h"

namespace evit::formats {

/// The events of a source in order of time: small disorder sorted, stamps far ahead dropped (TimeOrder).
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
  TimeOrder<Event> order_;
  EventArray piece_;
  bool more_ = true;
};

}  // namespace evit::formats
