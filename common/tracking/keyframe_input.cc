#include "common/tracking/keyframe_input.h"

namespace evit {

KeyframeInput InputOf(const Keyframe& keyframe) {
  // OpenCV has no image of constant pixels; this one is only copied from.
  const cv::Mat surface(keyframe.height, keyframe.width, CV_8UC1,
                        const_cast<std::uint8_t*>(keyframe.surface.data()));
  return {keyframe.utime,  keyframe.seq, static_cast<int>(keyframe.n_events),
          surface.clone(), keyframe.imu, keyframe.imu_gap};
}

}  // namespace evit
