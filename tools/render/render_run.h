#pragma once

#include <optional>
#include <string>
#include <utility>

#include "tools/render/run_painter.h"

namespace evit::render {

struct RenderOptions {
  std::string log, map, rig, out;                    // files; `out`: .mp4 or .gif
  std::string prefix;                                // of the channels
  double fps = 20;                                   // pictures per second
  double speed = 1;                                  // seconds of the recording per second
  std::optional<std::pair<double, double>> seconds;  // part of the recording
  PaintOptions paint;
};

/// Makes a film of a recorded run. The file appears when it is complete. Returns the number of pictures.
/// Throws std::runtime_error naming the file and the remedy: an input that cannot be used, an ending that is
/// not known, no room on the disk.
int RenderRun(const RenderOptions& options);

}  // namespace evit::render
