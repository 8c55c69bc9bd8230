#pragma once

#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit {

/// What more keyframes could still bring.
struct KeyframeNeed {
  Matrix6d random;  // covariance of the newest pose from all keyframes of the window alone: more keyframes
                    // lower it
  Matrix6d systematic;     // the part of the covariance that they do not
  Utime interval = 0;      // us: of these keyframes, in the mean
  double image_speed = 0;  // pixels/s; 0: unknown
  int image_width = 640;   // pixels
};

/// us: how long after the newest the next keyframe may come. The random part of the covariance grows with the
/// interval; until it is a third of the systematic part, both in position and in rotation, the pose is known
/// within a sixth of the sigma that any number of keyframes would leave. The image moves by a twentieth of
/// its width at most meanwhile. 0: the sooner the better, as where the systematic part is not known.
Utime UsefulInterval(const KeyframeNeed& need);

}  // namespace evit
