#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/config/tracker.pb.h"
#include "common/events/active_event_surface.h"
#include "common/events/event.h"

namespace evit {

/// us: an event further away in time than this leaves nothing on a surface with this decay and truncation
/// (grey levels).
double VisibleUs(double decay_us, double truncation);

/// Draws negated time surfaces (paper Sec. III-B.2).
///
/// T = 255 exp(-|dt| / decay) of the event nearest in time to the instant drawn, 0 below the truncation,
/// blurred, and negated: 0 is an event just now, 255 none. |dt| looks back only (causal), or to both sides
/// where events after the instant are given: then the valley lies on the edge and not behind it.
class SurfaceRenderer {
 public:
  using Image = std::vector<std::uint8_t>;  // row-major [height][width]

  SurfaceRenderer(int width, int height, const config::Surface& settings);

  struct View {
    Utime t = 0;                        // the instant; `surface` holds exactly the events up to it
    double decay_us = 0;                // > 0
    const EventArray* after = nullptr;  // events [begin, end) of it come after t; null: none
    std::size_t begin = 0, end = 0;
    const std::vector<std::int32_t>* ignored =
        nullptr;  // pixels (y * width + x) taken for defect; null: none
  };
  /// One image, or two where the settings split polarities: brighter, then darker.
  std::vector<Image> Render(const ActiveEventSurface& surface, const View& view);

 private:
  void FillDistances(const ActiveEventSurface& surface, const View& view, bool first, bool second,
                     std::vector<std::int32_t>* distances) const;
  void FindNear(const std::vector<std::int32_t>& distances, double decay_us);
  void MakeTable(double decay_us);
  Image Draw(const std::vector<std::int32_t>& distances);

  int width_, height_;
  double truncation_, sigma_;
  bool split_, support_;
  std::vector<std::int32_t> distances_[2];  // us to the nearest event
  std::vector<std::uint8_t> near_;          // [height + 2][width + 2]: an event close in time
  std::vector<std::uint8_t> table_;         // T by distance >> shift_; last: none
  std::int32_t max_distance_ = 0;           // us; beyond: T = 0
  int shift_ = 0;
  cv::Mat image_;
};

}  // namespace evit
