#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/events/event.h"

namespace evit::bench {

/// A time surface as it is plainly written: one struct for each event, double seconds, std::exp for each
/// pixel, a Gaussian blur of doubles, undistortion by cv::remap.
class ReferenceSurface {
 public:
  struct Event {
    double t;  // s
    int x, y;
    bool polarity;
  };
  ReferenceSurface(int width, int height);
  void Update(const std::vector<Event>& events);
  /// Negated, 0..255.
  cv::Mat Render(double t, double decay_s);

  static std::vector<Event> From(const EventArray& events);

 private:
  cv::Mat latest_[2];  // CV_64F: s
  cv::Mat map_x_, map_y_;
};

}  // namespace evit::bench
