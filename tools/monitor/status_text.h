#pragma once

#include <string>

#include "procman/sheriff.h"
#include "tools/monitor/pipeline_watch.h"

namespace evit::monitor {

/// What there is to say beside the monitor's own figures.
struct MonitorFigures {
  bool read_only = false;
  int viewers = 0;
  std::string waiting;  // for a pipeline: why nothing comes; empty: connected to the bus
};

/// JSON for the page, "type": "status": services, processes, channels, camera and its mount, map, the monitor
/// itself. `watch` and `sheriff` may be null while there is no bus.
std::string StatusText(const PipelineWatch* watch, const procman::Sheriff* sheriff,
                       const MonitorFigures& figures);

/// "type": "mode": what the tracker is doing and why; nothing that differs from keyframe to keyframe.
std::string ModeText(const tracker_mode_t& mode);

/// "type": "places": candidates of a search for the start, best first, at most 32.
std::string PlacesText(const places_t& places);

/// "type": "drawn": `ms` after its instant a picture was on the viewer's screen, and the viewer had said so.
std::string DrawnText(double ms);

/// "type": "answer": to an order.
std::string AnswerText(bool ok, const std::string& text);

}  // namespace evit::monitor
