#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// A regular camera at the event camera's place, as DAVIS sensors have one.
struct FrameSettings {
  double rate_hz = 0;      // 0: none
  double scale = 1;        // size of its images, share of the event camera's
  double exposure_ms = 3;  // over which light is collected
  double gamma = 2.2;
  double grey_noise = 1.5;  // grey levels
};

/// Writes its pictures from `begin` to `end` into `folder` (made) as camera/SECONDS.png (8 bit, named by the
/// middle of the exposure), camera_poses.tum (T_map_camera of each), and camera.textproto (calibration, place
/// on the body and marker). `progress`: 0..1. Throws std::runtime_error naming the file.
void WriteCameraFrames(const std::string& folder, const Scene& scene, const Rig& rig,
                       const PoseSpline& motion, Utime begin, Utime end, const FrameSettings& settings,
                       std::uint64_t seed, int threads, const std::function<void(double)>& progress);

}  // namespace evit::simulation
