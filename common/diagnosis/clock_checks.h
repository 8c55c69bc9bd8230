#pragma once

#include <vector>

#include "common/alignment/event_flow.h"
#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Do events and IMU cover the same time, and does the camera see motion when the gyro turns? `time_offset`:
/// us to add to event stamps to get IMU time, by the rig file.
/// `flow`: the image's motion, events' clock: it must turn with the gyro. Translation is in it too and may
/// look like an offset of 25 ms; what exceeds that by four standard errors counts, which chance does in one
/// of 16,000 recordings. Short or steady motions leave errors of tens of milliseconds; a map and known poses
/// tell more (CheckPlacement).
Findings CheckClocks(const EventCensus& events, const std::vector<FlowSample>& flow,
                     const std::vector<ImuSample>& imu, Utime time_offset);

/// By how much the event rate lags behind the gyro's magnitude, by their correlation. Rough, some 10 ms; it
/// finds a clock that is off by tenths of a second.
struct RateLag {
  Utime lag = 0;           // us to add to event stamps for the best correlation
  double correlation = 0;  // there
  double as_is = 0;        // at none
};
RateLag FindRateLag(const EventCensus& events, const std::vector<ImuSample>& imu, Utime time_offset,
                    Utime reach = 1'000'000);

}  // namespace evit::diagnosis
