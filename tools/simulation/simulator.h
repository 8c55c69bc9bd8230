#pragma once

#include <functional>
#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/simulation_settings.h"
#include "tools/simulation/simulation_summary.h"

namespace evit::simulation {

/// Simulates a whole sequence into settings.out, in VECtor's file layout: <name>1.synced.{left_event.hdf5,
/// imu.txt,gt.txt}, map.pcd, rgbd/ (see WriteRgbdViews), camera/ (see WriteCameraFrames), true_edges.pcd,
/// truth.tum (T_map_body), rig.textproto, simulation.json, preview_*.png. Files appear there only when all
/// are whole. `progress`: 0..1. Throws std::runtime_error where an input cannot be used or a file not be
/// written.
SimulationSummary Simulate(const SimulationSettings& settings, const Rig& rig, const std::string& rig_name,
                           const std::function<void(double)>& progress);

}  // namespace evit::simulation
