#pragma once

#include <cstdint>
#include <string>

#include "tools/simulation/camera_frames.h"
#include "tools/simulation/disturbance_settings.h"
#include "tools/simulation/event_sensor.h"
#include "tools/simulation/map_settings.h"
#include "tools/simulation/motion_settings.h"
#include "tools/simulation/optics.h"
#include "tools/simulation/readout.h"
#include "tools/simulation/room_settings.h"
#include "tools/simulation/simulated_imu.h"

namespace evit::simulation {

/// What `evit simulate` is asked for.
struct SimulationSettings {
  MotionSettings trajectory;
  RoomSettings room;
  std::uint64_t seed = 1;         // all noise
  std::string profile = "ideal";  // that was applied (profile.h): kept in simulation.json
  std::string name;               // of the sequence; empty: from the trajectory
  std::string out;                // folder, made where missing
  std::string command;            // kept in simulation.json
  double max_step_px = 0.7;       // image motion between two renders
  OpticsSettings optics;
  EventSensorSettings sensor;
  ReadoutSettings readout;
  ImuSettings imu;
  MapSettings map;
  DisturbanceSettings disturbances;
  FrameSettings frames;
  bool true_edges = false;  // also a dense map without errors
  bool rgbd = false;        // also the map's views as images with depth
  bool map_only = false;    // write map.pcd (and rgbd/, camera/, true_edges.pcd) alone: another map for a
                            // sequence that is there
  int previews = 0;
  int threads = 2;
};

}  // namespace evit::simulation
