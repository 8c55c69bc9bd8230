#include "tools/formats/rpg/text_recording.h"

#include <stdexcept>

#include "common/files/table_reader.h"
#include "tools/formats/rpg/rpg_events.h"

namespace evit::formats {

bool TextRecording::Recognises(const std::string& path) {
  try {
    TableReader rows(path, "t x y p");
    if (!rows.Next() || rows.WordsLeft() != 4) return false;
    Utime t = 0;
    return rows.Time(&t);
  } catch (const std::runtime_error&) {  // no text
    return false;
  }
}

std::unique_ptr<EventSource> TextRecording::Events(int width, int height) {
  return std::make_unique<RpgEvents>(path_, width, height);
}

}  // namespace evit::formats
