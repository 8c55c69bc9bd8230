#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/camera.h"
#include "tools/simulation/placed_surface.h"

namespace evit::simulation {

/// Pixels [begin[y], end[y]) of rows first_row..last_row that may see the surface: conservative by a pixel or
/// two. `bound_x`, `bound_y`: range of the image's rays. False where the surface is out of view.
bool FindScreenSpans(const Camera& camera, const double bound_x[2], const double bound_y[2],
                     const PlacedSurface& placed, std::vector<std::int16_t>* begin,
                     std::vector<std::int16_t>* end, int* first_row, int* last_row);

}  // namespace evit::simulation
