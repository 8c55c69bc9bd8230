#include "tools/formats/rpg/text_recording.h"

#include <stdexcept>
#include <tuple>

#include "tools/formats/import/event_columns.h"
#include "tools/formats/rpg/rpg_events.h"

namespace evit::formats {

bool TextRecording::Recognises(const std::string& path) {
  try {
    return HoldsEvents(SampleTable(path, "t x y p", 20));
  } catch (const std::runtime_error&) {  // no text
    return false;
  }
}

RecordingInfo TextRecording::info() const {
  const EventColumns columns = FindEventColumns(path_);
  RecordingInfo info{"text,", "", 0, 0};
  constexpr const char* kNames[] = {" t", " x", " y", " p", " ns", " -"};
  for (std::size_t k = 0; k < columns.n; ++k) info.format += kNames[columns.field[k]];
  if (columns.size) std::tie(info.width, info.height) = *columns.size;
  return info;
}

std::unique_ptr<EventSource> TextRecording::Events(int width, int height) {
  return std::make_unique<RpgEvents>(path_, width, height);
}

}  // namespace evit::formats
