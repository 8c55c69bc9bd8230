#pragma once

#include <vector>

#include "common/imu/imu_sample.h"
#include "evit/imu_batch_t.hpp"
#include "evit/keyframe_t.hpp"

/// IMU samples in messages. Incoming messages must have been checked (DecodeChecked).
namespace evit {

/// A batch of one; seq and epoch are the caller's.
imu_batch_t ToMessage(const ImuSample& sample);
std::vector<ImuSample> SamplesOf(const imu_batch_t& message);

/// The samples a keyframe carries.
void PutSamples(const std::vector<ImuSample>& samples, keyframe_t* message);
std::vector<ImuSample> SamplesOf(const keyframe_t& message);

}  // namespace evit
