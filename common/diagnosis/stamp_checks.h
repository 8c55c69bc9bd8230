#pragma once

#include <vector>

#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Are the stamps of events and IMU microseconds, and are those of events fine enough? The rig file's rate
/// tells the IMU's unit, and the IMU's length that of the events. `events`, `imu`: as far as they were read;
/// seconds: from the first to the last of each in the whole log, 0 where unknown.
Findings CheckStamps(const EventCensus& events, double event_seconds, const std::vector<ImuSample>& imu,
                     double imu_seconds, const Rig& rig);

}  // namespace evit::diagnosis
