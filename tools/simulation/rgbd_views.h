#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "tools/simulation/edge_map.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// The camera without its lens distortion: same size, focal lengths and centre.
Camera Rectified(const Camera& camera);

/// Writes posed RGB-D views at `times` into `folder` (made): for view i images/%05d.png (8-bit grey) and
/// depth/%05d.png (16 bit, mm along the optical axis, 0: nothing there), row i of poses.txt (4x4 camera to
/// map, row-major, m) and K.txt (3x3, of all views; pixel (0, 0) is the centre of the top left pixel).
/// Rectified. With the map's errors: depth noise for each pixel, and the same misplacement of view i as in
/// MakeEdgeMap with this seed. Throws std::runtime_error naming the file.
void WriteRgbdViews(const std::string& folder, const Scene& scene, const Rig& rig, const PoseSpline& motion,
                    const std::vector<Utime>& times, const MapSettings& settings, std::uint64_t seed,
                    int threads);

}  // namespace evit::simulation
