#pragma once

namespace evit::simulation {

/// What happens in the world that a map knows nothing of. Times are seconds of the sequence.
struct DisturbanceSettings {
  double lamp_off_s = 0, lamp_on_s = 0;   // equal: never off
  double lamp_share = 0.35;               // of the light, that remains while the lamp is off
  double dark_from_s = 0, dark_to_s = 0;  // lens covered; equal: never
  bool moving_box = false;                // see MovingBox
};

}  // namespace evit::simulation
