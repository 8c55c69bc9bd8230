#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/map/point_map.h"
#include "common/mapping/map_builder.h"
#include "tools/mapping/frame_reader.h"

/// What `evit map build` says, refuses and writes.
namespace evit::mapping {

/// Why no map is written under a name that ends like this. Empty: one is.
std::string CannotWriteMap(const std::string& path);

/// What was left out, in words.
std::vector<std::string> NotesOn(const FrameList& list, const ReadFrames& frames);

/// What looks wrong with a map, and what to do; empty: nothing does.
std::string DoubtOf(const BuiltMap& built);

/// The map with what is known of each point.
PointMap MapOf(const BuiltMap& built);

/// The fitted poses, T_map_camera, at the stamps of their pictures.
Trajectory PosesOf(const BuiltMap& built, const std::vector<Utime>& stamps);

/// Some lines for people.
std::string SummaryOf(const std::string& path, const BuiltMap& built);

}  // namespace evit::mapping
