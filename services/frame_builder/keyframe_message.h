#pragma once

#include "common/events/keyframe_builder.h"
#include "evit/imu_batch_t.hpp"
#include "evit/keyframe_t.hpp"
#include "evit/tracker_mode_t.hpp"

/// Between what is on the bus and what the keyframe builder takes and gives. Incoming messages must have been
/// checked (DecodeChecked).
namespace evit {

/// All fields but epoch, which is the caller's. Moves the surface out of `keyframe`.
keyframe_t ToMessage(Keyframe keyframe);

TrackerFeedback ToFeedback(const tracker_mode_t& message);

std::vector<ImuSample> ToSamples(const imu_batch_t& message);

}  // namespace evit
