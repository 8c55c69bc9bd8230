#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"

namespace evit::diagnosis {

/// Everything that an assumption can change.
struct World {
  Rig rig;
  Trajectory truth;
  bool mirror_x = false, mirror_y = false;
};

/// Something that may be otherwise than rig file and truth say.
struct Assumption {
  std::string what, remedy;  // for a person
  std::function<void(World*)> make;
  std::string check = "map-overlap";  // that it is a finding of
  double gain = 1.3;                  // overlap with it over that without, at least
};

/// What is usually wrong where a map does not lie on the events, the most usual first: extrinsics inverted,
/// turned or off by some degrees, a truth of another body, a mirrored image, intrinsics of another
/// resolution, another clock, a turned map. `rig`: for remedies that state a value.
std::vector<Assumption> Assumptions(const Rig& rig);

}  // namespace evit::diagnosis
