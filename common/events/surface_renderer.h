#pragma once

#include <cstdint>
#include <vector>

#include "common/events/active_event_surface.h"
#include "common/events/event.h"
#include "common/events/surface_options.h"
#include "common/events/surface_rows.h"

namespace evit {

/// us: an event further away in time than this leaves nothing on a surface with this decay and truncation
/// (grey levels).
double VisibleUs(double decay_us, double truncation);

/// Draws negated time surfaces (paper Sec. III-B.2).
///
/// T = 255 exp(-|dt| / decay) of the event nearest in time to the instant drawn, 0 below the truncation,
/// blurred, and negated: 0 is an event just now, 255 none (line by line in reference_surface.cc). |dt| looks
/// back only (causal), or to both sides where events after the instant are given: then the valley lies on the
/// edge and not behind it.
class SurfaceRenderer {
 public:
  using Image = std::vector<std::uint8_t>;  // row-major [height][width]

  SurfaceRenderer(int width, int height, const SurfaceOptions& options);

  struct View {
    Utime t = 0;                        // the instant; `surface` holds exactly the events up to it
    double decay_us = 0;                // > 0
    const EventArray* after = nullptr;  // events [begin, end) of it come after t; null: none
    std::size_t begin = 0, end = 0;
    const std::vector<std::int32_t>* ignored =
        nullptr;  // pixels (y * width + x) taken for defect; null: none
  };
  Image Render(const ActiveEventSurface& surface, const View& view);

 private:
  void FillDistances(const ActiveEventSurface& surface, const View& view);

  int width_, height_;
  double truncation_;
  bool support_;
  int shift_ = 0;                         // distances are in units of 2^shift us
  std::vector<std::uint16_t> distances_;  // to the nearest event
  SurfacePass pass_;
};

}  // namespace evit
