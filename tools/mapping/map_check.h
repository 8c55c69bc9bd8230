#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "common/overlap/map_event_overlap.h"
#include "common/overlap/misplacement.h"

namespace evit::mapping {

struct MapCheckInputs {
  std::string log;    // LCM log with EVENTS; IMU where gravity is to be checked
  std::string map;    // point cloud
  std::string rig;    // rig file
  std::string truth;  // TUM: body in the map frame
};

/// Something that looks wrong.
struct CheckFinding {
  bool is_error = false;  // the recording cannot be tracked on this map as it is; else tracking may suffer
  std::string text;       // in words, with the command that mends it
};

/// How a map lies on the events of a recording with known poses.
struct MapCheck {
  std::vector<MapView> views;            // with their events
  std::vector<MapEventOverlap> moments;  // of each view
  MapEventOverlap overlap;               // of all
  double point_share = 0;                // as the fits count it
  std::size_t moments_planned = 0;       // along the way, at which the map should be in view
  std::vector<Misplacement> fits;        // what would fit better, kind by kind
  MapEventOverlap corrected;             // with the best of them made
  std::size_t cells = 0;                 // of 5 cm that hold points of the map,
  std::size_t cells_seen = 0;            // were in view five times or more,
  std::size_t cells_silent = 0;          // and never fired
  double tilt_deg = 0;                   // of gravity against -z of the map
  bool has_imu = false;
  std::vector<CheckFinding> findings;  // errors first; empty: all is well
};

/// Compares. Throws std::runtime_error naming the file where one cannot be read, truth and log lie in
/// different times, or the map is never in view.
MapCheck CheckMap(const MapCheckInputs& inputs, const std::function<void(double)>& progress);

/// Figures and findings for people.
std::string CheckText(const MapCheckInputs& inputs, const MapCheck& check);

}  // namespace evit::mapping
