#pragma once

#include <string>

#include "tools/formats/bag/bag_reader.h"
#include "tools/formats/import/event_filter.h"
#include "tools/formats/import/event_source.h"

namespace evit::formats {

/// The events of one topic.
class BagEvents : public EventSource {
 public:
  BagEvents(const BagFiles& files, const std::string& topic, int width, int height);

  bool Read(EventArray* events) override;
  double share() const override { return reader_.share(); }
  std::string name() const override { return name_; }
  DropCounts dropped() const override { return filter_.dropped(); }

 private:
  std::string name_;
  BagReader reader_;
  EventFilter filter_;
};

}  // namespace evit::formats
