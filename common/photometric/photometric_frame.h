#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "common/time/utime.h"

namespace evit {

/// Signed event counts of one frame.
struct PhotometricFrame {
  Utime t = 0;  // us: the instant whose pose is asked for
  std::int64_t seq = 0;
  int n_events = 0;          // since the previous frame
  Utime begin = 0, end = 0;  // us: events in (begin, end] are counted
  cv::Mat counts;            // CV_8UC1, EventCounter's
};

}  // namespace evit
