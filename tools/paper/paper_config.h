#pragma once

#include <string>

#include "tools/paper/paper.pb.h"

namespace evit::paper {

/// Reads config/paper.textproto. Paths to tracker settings and rig are made absolute (they are beside the
/// file). Throws ConfigError naming file, key and remedy: unknown or missing key, an id or a sequence that
/// occurs twice or is not a file name, figures of what is not there, a clip that ends before it begins.
paper::Paper LoadPaper(const std::string& path);

/// Every run's settings: methods, then those motion models that are not methods too.
std::vector<paper::Method> AllMethods(const paper::Paper& config);

/// Whether a method tracks against a photometric map (EVPT).
bool IsPhotometric(const paper::Method& method);

/// The tracker settings of one method: its file with the changes asked for, as text. Throws ConfigError.
std::string TrackerText(const paper::Method& method);

}  // namespace evit::paper
