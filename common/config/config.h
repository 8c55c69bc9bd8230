#pragma once

#include <stdexcept>
#include <string>

#include "common/config/pipeline_options.h"
#include "common/config/rig.pb.h"
#include "common/config/tracker.pb.h"
#include "common/geometry/rig.h"

namespace evit {

/// A configuration file that cannot be used; what() names file, line and field, and the remedy.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads a rig file. Throws ConfigError: not readable, unknown or missing key, wrong number of values, a
/// rotation that is not one, a value out of its range.
Rig LoadRig(const std::string& path);

/// A rig file's name for people. Throws ConfigError as LoadRig does.
std::string LoadRigName(const std::string& path);

/// Reads a tracker file. Throws ConfigError as LoadRig does.
config::Tracker LoadTracker(const std::string& path);

/// The same as plain options. Throws ConfigError as LoadRig does.
PipelineOptions LoadOptions(const std::string& path);
PipelineOptions ToOptions(const config::Tracker& message);

}  // namespace evit
