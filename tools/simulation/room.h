#pragma once

#include <cstdint>

#include "tools/simulation/room_settings.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// A furnished room of about 5 x 5 x 2.8 m, another one for each seed: floor at z = 0, centre at x = y = 0.
/// Posters and plain walls, a sofa, tables, shelves with boxes, balls and columns; most of it towards +x. The
/// free space is a box around (-0.5, 0, 1.35).
Scene MakeRoom(std::uint64_t seed, RoomKind kind = RoomKind::kFurnished);

}  // namespace evit::simulation
