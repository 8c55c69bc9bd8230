#pragma once

#include <string>

#include "common/geometry/rig.h"

namespace evit {

/// Reads a rig file (schema: common/config/rig.proto), or Kalibr's camchain-imucam.yaml (kalibr_file.h).
/// Throws ConfigError naming file, line and remedy: not readable, unknown or missing key, wrong number of
/// values, a rotation that is not one, a value out of range.
Rig LoadRig(const std::string& path);

/// The camera of a rig file, or of a file that holds nothing but its `camera` block (then time_offset_us,
/// which is about an IMU, may be missing), with where it sits and how its clock goes, as far as the file has
/// them (blocks T_body_camera and T_marker_body, as in a rig file). Throws ConfigError as LoadRig does.
MountedCamera LoadMountedCamera(const std::string& path);

/// Writes a file that LoadMountedCamera reads back exactly. `comment`: one or more lines without '#'. Throws
/// std::runtime_error naming the file.
void WriteMountedCamera(const std::string& path, const MountedCamera& camera, const std::string& comment);

/// A rig file's name for people. Throws ConfigError as LoadRig does.
std::string LoadRigName(const std::string& path);

/// Writes a rig file that LoadRig reads back exactly, with the unit of each value. `comment`: where the
/// figures come from, one or more lines without '#'. Throws std::runtime_error naming the file.
void WriteRig(const std::string& path, const Rig& rig, const std::string& name, const std::string& comment);

}  // namespace evit
