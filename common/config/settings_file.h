#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/config/pipeline_options.h"
#include "common/config/setting.h"
#include "common/geometry/camera.h"

namespace evit {

/// A settings file with all that it is based on.
struct LoadedSettings {
  PipelineOptions options;
  std::map<std::string, Setting> set;  // by path: what files set, the last word on each
  std::vector<std::string> notes;      // keys that have another place now
};

/// Reads a settings file (schema: common/config/settings.proto) and the files it is based on. Throws
/// ConfigError naming file, line and remedy: not readable, an unknown or removed key, a value out of range or
/// at odds with another, files that are based on each other.
LoadedSettings LoadSettings(const std::string& path);

/// The options alone. An empty path: the defaults.
PipelineOptions LoadOptions(const std::string& path);

/// The same for a sensor of this size. What the file says nothing of follows a sensor wider than VGA: the
/// same motion crosses more pixels there and causes more events along each edge, so keyframes.n_event and
/// points.margin_px grow with the width. Smaller sensors keep those defaults (with fewer events a keyframe a
/// DAVIS240 had the same errors, for more CPU), but have fewer points.per_keyframe, in
/// proportion, half at least.
PipelineOptions LoadOptionsFor(const Camera& camera, const std::string& path);

}  // namespace evit
