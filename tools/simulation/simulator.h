#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/edge_map.h"
#include "tools/simulation/event_stage.h"
#include "tools/simulation/imu_simulator.h"
#include "tools/simulation/map_holes.h"
#include "tools/simulation/room.h"
#include "tools/simulation/trajectory_source.h"

namespace evit::simulation {

struct SimulationSettings {
  TrajectorySettings trajectory;
  std::uint64_t scene_seed = 1;  // the room
  RoomKind room = RoomKind::kFurnished;
  std::uint64_t seed = 1;    // all noise
  std::string name;          // of the sequence; empty: from the trajectory
  std::string out;           // folder, made where missing
  std::string command;       // kept in simulation.json
  double max_step_px = 0.7;  // image motion between two renders
  EventSensorSettings sensor;
  ImuSettings imu;
  MapSettings map;
  double lamp_off_s = 0, lamp_on_s = 0, lamp_share = 0.35;  // of the sequence; equal: never off
  bool rgbd = false;                                        // also the map's views as images with depth
  bool moving_box = false;                                  // see MovingBox; not in the map
  double dark_from_s = 0, dark_to_s = 0;                    // lens covered, s of the sequence; equal: never
  MapHoles map_holes;
  bool map_only = false;  // write map.pcd (and rgbd/) alone: another map for a sequence that is there
  int previews = 0;
  int threads = 2;
};

struct SimulationSummary {
  std::string name;
  Motion motion;
  MotionSpeed motion_speed;
  double duration_s = 0;
  std::size_t n_renders = 0, n_imu = 0, n_map_points = 0;
  int n_map_views = 0;
  EventCounts events;
  ImageSpeed speed;
  double mean_depth = 0;
  double wall_s = 0;
  ImuBias first_bias, last_bias;
};

/// "furnished" or "plain".
std::string RoomName(RoomKind room);

/// Simulates a whole sequence into settings.out, in VECtor's file layout: <name>1.synced.{left_event.hdf5,
/// imu.txt,gt.txt}, map.pcd, rgbd/ (see WriteRgbdViews), truth.tum (T_map_body), rig.textproto,
/// simulation.json, preview_*.png. Files appear there only when all are whole. `progress`: 0..1. Throws
/// std::runtime_error on anything wrong.
SimulationSummary Simulate(const SimulationSettings& settings, const Rig& rig, const std::string& rig_name,
                           const std::function<void(double)>& progress);

}  // namespace evit::simulation
