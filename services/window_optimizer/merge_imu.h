#pragma once

#include "evit/keyframe_t.hpp"

namespace evit {

/// For a keyframe that is dropped: makes `after`, the one that follows `before`, reach back over it, with
/// its IMU samples and its number of events. No effect where the two do not follow each other, or where the
/// samples would become too many (4000).
void MergeImu(const keyframe_t& before, keyframe_t* after);

}  // namespace evit
