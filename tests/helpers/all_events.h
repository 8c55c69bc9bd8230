#pragma once

#include <memory>

#include "tools/formats/import/recording.h"

namespace evit {

/// All events of a recording at once.
inline EventArray AllEvents(formats::Recording* recording, int width, int height,
                            formats::DropCounts* dropped = nullptr) {
  const std::unique_ptr<formats::EventSource> source = recording->Events(width, height);
  EventArray all, piece;
  while (source->Read(&piece)) {
    for (std::size_t k = 0; k < piece.size(); ++k)
      all.push_back(piece.t[k], piece.x[k], piece.y[k], piece.p[k]);
  }
  if (dropped != nullptr) *dropped = source->dropped();
  return all;
}

}  // namespace evit
