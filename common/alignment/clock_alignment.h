#pragma once

#include <cstddef>
#include <vector>

#include "common/alignment/event_flow.h"
#include "common/imu/imu_sample.h"

namespace evit {

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

/// The same with what it is worth, for streams that should be aligned already.
struct RotationLag {
  Utime offset = 0;            // us to add to IMU stamps, as above
  double sigma = 0;            // us, of that: by leaving out each eighth of the recording (jackknife)
  double explained = 0;        // share of the image's motion that the gyro explains there, 0..1
  double explained_as_is = 0;  // at none
  std::size_t pairs = 0;       // of flow and gyro; 0: no result, for lack of pairs or with the best at an end
};
/// Within `range` us around none; no result where the best is at an end of that.
RotationLag FindRotationLag(const std::vector<FlowSample>& flow, const std::vector<ImuSample>& imu,
                            Utime range);

}  // namespace evit
