#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/overlap/map_event_overlap.h"

namespace evit {

/// One way in which a map, the camera's poses and the events may be out of step: what would have to be added
/// so that they fit best, and how well they then do.
struct Misplacement {
  enum class Kind {
    kTime,      // x, s: to add to the events' stamps
    kRotation,  // rad, a rotation vector in the camera frame: T_body_camera * Exp(value) would fit
    kShift,     // m, map frame: to add to the poses' positions
    kScale,     // x: 1 + x times the poses' positions
    kFocal,     // x: 1 + x times the focal lengths
    kCentre     // x, y, pixels: to add to the principal point
  };
  Kind kind = Kind::kTime;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  double point_share = 0;  // of the points that then lie on events; 0: too few are in view to tell
};

struct MisplacementOptions {
  int max_views = 30;    // used, spread over all
  int max_points = 600;  // of each
  double radius_px = 2;  // "on" an event
  double reach_px = 8;   // of a point to its event
  int iterations = 15;
};

/// Share of the points (those that the options use) that lie on events as things are.
double PointShare(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
                  const MisplacementOptions& options = {});

/// For each kind by itself the best value, by least squares on the offsets of points to the nearest pixel
/// that fired, from the best of a few starts; zero where none is clearly better. Errors of one kind partly
/// look like another: compare the shares. `views`: with their events.
std::vector<Misplacement> FindMisplacements(const Rig& rig, const Trajectory& body,
                                            const std::vector<MapView>& views,
                                            const MisplacementOptions& options = {});

/// The same of one kind alone.
Misplacement FindMisplacement(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
                              Misplacement::Kind kind, const MisplacementOptions& options = {});

/// Takes it out of a rig and the body's poses, as if it had never been there.
void Correct(const Misplacement& misplacement, Rig* rig, Trajectory* body);

/// First `a`, then `b` of the same kind.
Misplacement Together(const Misplacement& a, const Misplacement& b);

/// How map and events lie on each other once the misplacement is corrected, in all views. A correction that
/// only some points suggest, by chance, does not explain what fires.
MapEventOverlap MeasureCorrected(const Rig& rig, const Trajectory& body, const std::vector<MapView>& views,
                                 const Misplacement& misplacement, const OverlapOptions& options = {});

}  // namespace evit
