#pragma once

#include <vector>

#include "common/imu/imu_sample.h"
#include "tools/formats/alignment/event_flow.h"

namespace evit::formats {

struct ClockAlignment {
  Utime offset = 0;      // us to add to IMU stamps to get the events' clock
  double explained = 0;  // share of the image's motion that the gyro explains then, 0..1
};

/// Finds the offset of two clocks at which the image's motion is best explained as a linear function of the
/// gyro (so no extrinsics are needed), within `range` us around `guess`. Where the streams do not overlap at
/// `guess` at all, their beginnings are taken as simultaneous instead. Throws std::runtime_error saying why
/// where it is not determined: too little motion, too steady, or two offsets that fit alike.
ClockAlignment AlignClocks(const std::vector<FlowSample>& flow, const std::vector<ImuSample>& imu,
                           Utime guess, Utime range);

}  // namespace evit::formats
