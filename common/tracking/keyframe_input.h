#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/events/keyframe.h"
#include "common/imu/imu_sample.h"

namespace evit {

/// What a tracker needs of one keyframe.
struct KeyframeInput {
  Utime t = 0;  // us
  std::int64_t seq = 0;
  int n_events = 0;            // since the previous keyframe
  cv::Mat surface;             // CV_8UC1, negated time surface
  std::vector<ImuSample> imu;  // from the previous keyframe's stamp to this one's, both ends included
  Utime imu_gap = 0;           // us: longest hole in those samples
};

/// Of a keyframe as KeyframeBuilder makes it, with an image of its own.
KeyframeInput InputOf(const Keyframe& keyframe);

}  // namespace evit
