#include "tools/formats/bag/bag_events.h"

#include "tools/formats/bag/ros_messages.h"

namespace evit::formats {

BagEvents::BagEvents(const BagFiles& files, const std::string& topic, int width, int height)
    : name_(files.Names() + ": " + topic), reader_(files, {topic}), filter_(width, height) {}

bool BagEvents::Read(EventArray* events) {
  events->clear();
  while (events->size() == 0 && reader_.Next()) {
    reader_.Decoded(
        [&](const std::uint8_t* data, std::size_t size) { DecodeEventArray(data, size, &filter_, events); });
  }
  return events->size() > 0;
}

}  // namespace evit::formats
