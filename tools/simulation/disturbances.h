#pragma once

#include "tools/simulation/cover.h"
#include "tools/simulation/lamp.h"
#include "tools/simulation/moving_box.h"

namespace evit::simulation {

/// What a map knows nothing of.
struct Disturbances {
  Lamp lamp;
  Cover cover;
  const MovingBox* box = nullptr;  // none where null
};

}  // namespace evit::simulation
